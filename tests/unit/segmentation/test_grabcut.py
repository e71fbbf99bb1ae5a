"""GrabCut, and what it prefers."""

import numpy as np
import pytest

from fitter.errors import InvalidInputError
from fitter.segmentation.grabcut import WEIGHT, border_warnings, preference, segment
from fitter.segmentation.trimap import TrimapLabel, first_band, trimap
from tests.unit.segmentation.plain_grabcut import opencv_grabcut
from tests.unit.segmentation.rendered_pictures import PICTURES, rendered_picture

NO_BONES = np.zeros((0, 2, 2))


def figure(*, height: int = 400, width: int = 300, dx: float = 0.0, dy: float = 0.0) -> np.ndarray:
    """A trunk with a head, two arms and two legs."""
    rows, columns = np.mgrid[:height, :width] + 0.5
    x, y = columns - width / 2 - dx, rows - height / 2 - dy
    trunk = (np.abs(x) < 40) & (np.abs(y + 20) < 70)
    head = np.hypot(x, y + 120) < 28
    arms = (np.abs(np.abs(x) - 70) < 12) & (np.abs(y + 20) < 70)
    shoulders = (np.abs(x) < 82) & (np.abs(y + 80) < 12)
    legs = (np.abs(np.abs(x) - 24) < 14) & (y > 0) & (y < 150)
    return trunk | head | arms | shoulders | legs


def picture(mask: np.ndarray, *, seed: int = 0) -> np.ndarray:
    """Skin with shading before a greenish wall with stripes, both noisy."""
    random = np.random.default_rng(seed)
    rows, columns = np.mgrid[: mask.shape[0], : mask.shape[1]]
    shading = 0.8 + 0.2 * np.sin(columns / 25)
    skin = np.array([0.8, 0.6, 0.5]) * shading[..., None]
    wall = np.array([0.3, 0.45, 0.35]) + 0.1 * np.sign(np.sin(rows / 9))[..., None]
    clean = np.where(mask[..., None], skin, wall)
    return np.clip(clean + 0.03 * random.normal(size=clean.shape), 0, 1).astype(np.float32)


def overlap(first: np.ndarray, second: np.ndarray) -> float:
    return (first & second).sum() / (first | second).sum()


def labels_from(silhouette: np.ndarray) -> np.ndarray:
    return trimap(silhouette, NO_BONES, band=first_band(silhouette, NO_BONES))


def test_a_figure_is_found_from_a_displaced_first_guess():
    truth = figure()
    guess = figure(dx=6, dy=-5)
    assert overlap(guess, truth) < 0.85
    found = segment(picture(truth), labels_from(guess))
    assert overlap(found.mask, truth) > 0.98
    assert found.warnings == ()


def test_the_gaps_between_arms_and_trunk_stay_open():
    truth = figure()
    found = segment(picture(truth), labels_from(figure(dx=3)))
    gap = (slice(140, 230), slice(94, 104))
    assert not truth[gap].any()
    assert found.mask[gap].mean() < 0.05


def test_a_narrow_gap_between_the_legs_of_a_large_figure_stays_open():
    rows, columns = np.mgrid[:900, :400] + 0.5
    x = columns - 200
    trunk = (np.abs(x) < 70) & (rows > 100) & (rows < 450)
    legs = (np.abs(np.abs(x) - 33) < 29) & (rows >= 450) & (rows < 800)
    truth = trunk | legs
    gap = (slice(500, 780), slice(198, 202))
    assert not truth[gap].any()
    # A muted picture: where colours differ little, a narrow gap is the first thing to be lost.
    shown = 0.35 + 0.25 * (picture(truth) - 0.35)
    guess = np.roll(truth, 3, axis=1)
    found = segment(shown.astype(np.float32), labels_from(guess))
    assert found.mask[gap].mean() < 0.1


@pytest.mark.slow
def test_the_masks_of_rendered_people_are_as_true_as_opencvs():
    ours, theirs = [], []
    for each in map(rendered_picture, PICTURES):
        found = segment((each.pixels / 255.0).astype(np.float32), each.labels).mask
        reference = opencv_grabcut(each.pixels, each.labels)
        assert overlap(found, reference) > 0.9
        ours.append(overlap(found, each.person))
        theirs.append(overlap(reference, each.person))
    # OpenCV's own random seed moves a mask by as much as 0.03.
    assert np.mean(ours) > np.mean(theirs) - 0.005


def test_a_small_picture_is_cut_at_its_own_size():
    truth = figure()[::2, ::2]
    found = segment(picture(truth), labels_from(truth))
    assert overlap(found.mask, truth) > 0.96


def test_the_same_picture_gives_the_same_mask():
    truth = figure()
    shown, labels = picture(truth), labels_from(figure(dx=4))
    np.testing.assert_array_equal(segment(shown, labels).mask, segment(shown, labels).mask)


def test_the_arguments_are_left_as_they_were():
    shown, labels = picture(figure()), labels_from(figure())
    shown_before, labels_before = shown.copy(), labels.copy()
    segment(shown, labels)
    np.testing.assert_array_equal(shown, shown_before)
    np.testing.assert_array_equal(labels, labels_before)


def test_skin_coloured_things_that_hang_on_nothing_are_left_out():
    truth = figure()
    with_ball = truth.copy()
    # Within the band beside the hip, not touching it.
    with_ball[260:272, 100:108] = True
    labels = labels_from(truth)
    found = segment(picture(with_ball), labels)
    assert not found.mask[262:270, 102:106].any()


def test_speckle_inside_the_person_is_filled():
    truth = figure()
    speckled = truth.copy()
    speckled[150:156, 148:154] = False
    labels = labels_from(truth)
    labels[140:170, 140:165] = TrimapLabel.LIKELY_FOREGROUND
    found = segment(picture(speckled), labels)
    assert found.mask[145:160, 145:158].all()


def test_a_picture_of_one_colour_is_refused():
    blank = np.full((400, 300, 3), 0.5, dtype=np.float32)
    with pytest.raises(InvalidInputError) as caught:
        segment(blank, labels_from(figure()))
    assert (caught.value.code, caught.value.field) == ("person-not-found", "image")


def test_a_tri_map_without_foreground_is_refused():
    labels = np.full((400, 300), TrimapLabel.BACKGROUND, dtype=np.uint8)
    with pytest.raises(InvalidInputError) as caught:
        segment(picture(figure()), labels)
    assert caught.value.code == "person-not-found"


def test_a_person_like_the_background_is_doubtful():
    noise = np.random.default_rng(0).uniform(0.3, 0.7, (400, 300, 1)).repeat(3, axis=2)
    found = segment(noise.astype(np.float32), labels_from(figure()))
    assert found.mask.any()
    # Nothing tells the sides apart: whatever comes out, no crash, and the sure part is kept.
    assert found.mask[labels_from(figure()) == TrimapLabel.FOREGROUND].all()


def test_a_person_who_fills_the_picture_is_all_foreground():
    silhouette = np.ones((400, 300), dtype=np.bool_)
    found = segment(picture(figure()), trimap(silhouette, NO_BONES, band=20))
    assert found.mask.all()
    assert [warning.code for warning in found.warnings] == ["body-outside-picture"]


@pytest.mark.parametrize(
    ("side", "window"),
    [
        ("top", np.s_[:50, 100:150]),
        ("bottom", np.s_[-50:, 100:150]),
        ("left", np.s_[100:150, :50]),
        ("right", np.s_[100:150, -50:]),
    ],
)
def test_a_body_cut_off_by_a_border_is_warned_of_by_side(side: str, window: tuple[slice, slice]):
    mask = np.zeros((400, 300), dtype=np.bool_)
    mask[window] = True
    (warning,) = border_warnings(mask)
    assert warning.code == "body-outside-picture"
    assert f"the {side} border" in warning.reason


def test_a_body_inside_the_picture_is_not_warned_of():
    assert border_warnings(figure()) == ()


def test_an_even_chance_says_nothing_and_a_certainty_is_bounded():
    seed = np.full((40, 30), 0.5, dtype=np.float32)
    seed[:, 10:20], seed[:, 20:] = 0.9, 1.0
    nats = preference(seed, None)
    np.testing.assert_allclose(nats[:, :10], 0.0, atol=1e-5)
    np.testing.assert_allclose(nats[:, 10:20], WEIGHT * np.log(9.0), rtol=1e-5)
    np.testing.assert_allclose(nats[:, 20:], WEIGHT * np.log(49.0), rtol=1e-4)


def test_the_mirror_image_of_a_chance_prefers_the_other_side():
    seed = np.linspace(0.0, 1.0, 40 * 30).reshape(40, 30)
    np.testing.assert_allclose(preference(seed, None), -preference(1.0 - seed, None), atol=1e-9)


def test_a_body_adds_its_inside_and_takes_its_outside():
    body = np.zeros((200, 150), dtype=np.bool_)
    body[20:180, 50:100] = True
    even = np.full(body.shape, 0.5, dtype=np.float32)
    nats = preference(even, body)
    assert nats[100, 75] > 20.0
    assert nats[100, 10] < -20.0
    np.testing.assert_allclose(nats[100, 49] + nats[100, 50], 0.0, atol=1e-3)
    np.testing.assert_allclose(preference(even, np.zeros_like(body)), nats.min(), rtol=1e-5)


def test_a_shaded_leg_of_the_walls_colour_is_kept_where_the_person_is_known_to_be():
    truth = figure()
    leg = truth & (np.arange(truth.shape[1]) < 140) & (np.arange(truth.shape[0])[:, None] > 260)
    shown = np.where(leg[..., None], picture(np.zeros_like(truth)), picture(truth))
    labels = trimap(figure(dx=2), NO_BONES, band=12)
    by_colour = segment(shown, labels).mask
    likely = np.where(truth, 0.9, 0.1).astype(np.float32)
    told = segment(shown, labels, preference(likely, None)).mask
    assert by_colour[leg].mean() < 0.5
    assert told[leg].mean() > 0.95
    assert overlap(told, truth) > overlap(by_colour, truth)
