"""Drawn dressed people, as broad as real ones, and what is learned from them."""

from itertools import count

import numpy as np
import pytest

from fitter.arrays import Mask
from fitter.detection.worn_parts import WornPart, load_head
from fitter.render.camera import Camera
from fitter.training.dressed.bodies import SIDES, StandingBody
from fitter.training.dressed.learning import learned, loss_and_slopes, write_head
from fitter.training.dressed.people import dressed_person
from fitter.training.dressed.pictures import SIZE, draw, dressed_picture
from fitter.training.dressed.samples import PIXELS, Samples, changed, chosen_pixels

ADDED_CM = {0.58: (11.0, 6.7), 0.50: (4.4, 5.3)}
"""What an outer garment adds to the outline's breadth, by share of the stature: mean and deviation
of 32 real people with raised arms."""

CAMERA = Camera(focal_length_px=900.0, centre_x=200.0, centre_y=200.0, width=400, height=400)
AWAY_M = 5.0


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(20261127)


def test_a_number_is_a_picture():
    one, same, other = (dressed_picture(seed) for seed in (3, 3, 4))
    assert np.array_equal(one.picture, same.picture)
    assert np.array_equal(one.labels, same.labels)
    assert not np.array_equal(one.labels, other.labels)


@pytest.mark.parametrize("seed", range(6))
def test_pictures_show_a_person_with_skin(seed: int):
    picture, labels = dressed_picture(seed)
    assert picture.shape == (SIZE, SIZE, 3)
    assert set(np.unique(labels)) <= set(WornPart)
    assert {WornPart.BACKGROUND, WornPart.SKIN} <= set(np.unique(labels))
    assert 0.03 < (labels > 0).mean() < 0.5


def has_raised_arms(body: StandingBody) -> bool:
    shoulder = body.marks["left_shoulder"][1]
    wrists = [body.marks[f"{side}_wrist"] for side, _ in SIDES]
    return all(abs(wrist[0]) > 0.42 and wrist[1] < shoulder for wrist in wrists)


def breadth_cm(person: Mask, share: float) -> float:
    """Of the piece about the trunk's middle at a share of the height."""
    rows = np.flatnonzero(person.any(axis=1))
    line = person[int(rows[-1] - share * (rows[-1] - rows[0]))]
    gaps = np.flatnonzero(~line)
    middle = int(CAMERA.centre_x)
    across = gaps[gaps > middle].min() - gaps[gaps < middle].max() - 1
    return float(100.0 * across * AWAY_M / CAMERA.focal_length_px)


@pytest.mark.slow
def test_outer_garments_add_as_much_to_the_outline_as_real_ones():
    ahead, place = np.diag([1.0, -1.0, -1.0]), np.array([0.0, 0.0, AWAY_M])
    added: list[np.ndarray] = []
    for seed in count():
        rng = np.random.default_rng(seed)
        body, layers = dressed_person(rng)
        inner = [each for each in layers if each.part is not WornPart.OUTER]
        if len(inner) == len(layers) or not has_raised_arms(body):
            continue
        outlines = [draw(some, CAMERA, ahead, place, rng).labels > 0 for some in (layers, inner)]
        over, under = ([breadth_cm(each, share) for share in ADDED_CM] for each in outlines)
        added.append(np.subtract(over, under))
        if len(added) == 20:
            break
    for found, (mean, deviation) in zip(np.transpose(added), ADDED_CM.values(), strict=True):
        assert abs(found.mean() - mean) < 0.5 * deviation
        assert 0.5 * deviation < found.std() < 1.5 * deviation


def test_what_is_changed_keeps_its_labels(rng: np.random.Generator):
    labels = np.zeros((SIZE, SIZE), np.uint8)
    labels[80:200, 100:160] = WornPart.CLOTH
    picture = np.full((SIZE, SIZE, 3), 30, np.uint8)
    picture[labels > 0] = 220
    drawn = dressed_picture(0)._replace(picture=picture, labels=labels)
    for _ in range(5):
        look = changed(drawn, rng)
        there = look.picture.mean(axis=2) > look.picture.mean()
        assert (there == (look.labels > 0)).mean() > 0.98


def test_every_part_that_is_there_is_sampled(rng: np.random.Generator):
    labels = dressed_picture(3).labels
    chosen, stands_for = chosen_pixels(labels, rng)
    assert set(np.unique(labels)) == set(np.unique(labels.ravel()[chosen]))
    assert 0.5 * PIXELS < len(chosen) <= PIXELS
    of_person = labels.ravel()[chosen] > 0
    assert stands_for[of_person].sum() == pytest.approx((labels > 0).sum(), rel=1e-4)


def test_slopes_are_finite_differences_of_the_loss(rng: np.random.Generator):
    at = [rng.normal(size=shape) for shape in ((5, 4), (4,), (4, 3), (3,), (3, 6), (6,))]
    read = rng.normal(size=(7, 5))
    labels = rng.integers(0, 6, 7)
    _, slopes = loss_and_slopes(at, read, labels)
    for number, each in enumerate(at):
        direction = rng.normal(size=each.shape)
        losses = []
        for step in (-1e-6, 1e-6):
            moved = [*at]
            moved[number] = each + step * direction
            losses.append(loss_and_slopes(moved, read, labels)[0])
        slope = (losses[1] - losses[0]) / 2e-6
        assert (slopes[number] * direction).sum() == pytest.approx(slope, rel=1e-5, abs=1e-8)


def test_what_a_plane_tells_apart_is_learned(rng: np.random.Generator, tmp_path):
    read = rng.normal(3.0, 2.0, (6_000, 8))
    labels = np.where(read[:, 0] > 3.0, WornPart.SKIN, WornPart.CLOTH).astype(np.int64)
    *_, (_, head) = learned(Samples(read.astype(np.float16), labels, np.ones(6_000)), 20, rng)
    write_head(tmp_path / "head.npz", head)
    stored = load_head(tmp_path / "head.npz")
    values = read
    for number, (weights, biases) in enumerate(zip(stored.weights, stored.biases, strict=True)):
        values = (np.maximum(values, 0.0) if number else values) @ weights + biases
    assert (values.argmax(axis=1) == labels).mean() > 0.97
