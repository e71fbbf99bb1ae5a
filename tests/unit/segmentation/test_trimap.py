import numpy as np
import pytest

from fitter.request import Click
from fitter.segmentation.bones import BONES, clicked_bones
from fitter.segmentation.trimap import (
    TrimapLabel,
    body_size,
    first_band,
    is_uncertain,
    seeded_person,
    seeded_trimap,
    trimap,
    trimap_picture,
)

NO_BONES = np.zeros((0, 2, 2))


def disc(radius: float, *, height: int = 200, width: int = 240) -> np.ndarray:
    rows, columns = np.mgrid[:height, :width] + 0.5
    return np.hypot(columns - width / 2, rows - height / 2) < radius


def test_a_discs_band_lies_between_two_discs():
    labels = trimap(disc(60), NO_BONES, band=20)
    foreground = labels == TrimapLabel.FOREGROUND
    background = labels == TrimapLabel.BACKGROUND
    # Distances run between pixel centres: the border is known to a pixel.
    assert (foreground >= disc(39)).all()
    assert (foreground <= disc(41)).all()
    assert (background >= ~disc(81)).all()
    assert (background <= ~disc(79)).all()


def test_the_band_of_a_box_is_as_many_pixels_wide_as_it_is_told_on_either_side():
    silhouette = np.zeros((100, 100), dtype=np.bool_)
    silhouette[20:80, 30:70] = True
    across = trimap(silhouette, NO_BONES, band=5)[50]
    assert np.flatnonzero(across == TrimapLabel.FOREGROUND)[[0, -1]].tolist() == [35, 64]
    assert np.flatnonzero(across != TrimapLabel.BACKGROUND)[[0, -1]].tolist() == [25, 74]


def test_the_band_leans_to_the_foreground_well_inside_only():
    labels = trimap(disc(60), NO_BONES, band=20)
    likely = labels == TrimapLabel.LIKELY_FOREGROUND
    assert (likely <= disc(51)).all()
    assert likely[disc(48) & ~disc(42)].all()
    assert ((labels == TrimapLabel.LIKELY_BACKGROUND) >= disc(78) & ~disc(52)).all()


def test_a_body_cut_by_the_pictures_border_is_not_eroded_there():
    silhouette = np.zeros((100, 100), dtype=np.bool_)
    silhouette[40:, 30:70] = True
    labels = trimap(silhouette, NO_BONES, band=5)
    assert (labels[-1, 40:60] == TrimapLabel.FOREGROUND).all()


def test_a_bone_stays_where_its_limb_is_eroded_away():
    silhouette = np.zeros((200, 100), dtype=np.bool_)
    silhouette[20:180, 48:54] = True
    bone = np.array([[[51.0, 30.0], [51.0, 170.0]]])
    without = trimap(silhouette, NO_BONES, band=10)
    with_bone = trimap(silhouette, bone, band=10)
    assert not (without == TrimapLabel.FOREGROUND).any()
    assert (with_bone[35:165, 50:52] == TrimapLabel.FOREGROUND).all()


def test_the_band_reaches_round_a_bone_off_the_silhouette():
    silhouette = np.zeros((200, 200), dtype=np.bool_)
    silhouette[20:180, 20:40] = True
    bone = np.array([[[150.0, 50.0], [150.0, 150.0]]])
    labels = trimap(silhouette, bone, band=12)
    assert is_uncertain(labels)[100, [140, 160]].all()
    assert labels[100, 149] == TrimapLabel.FOREGROUND
    assert labels[100, 100] == TrimapLabel.BACKGROUND


def test_nothing_at_all_is_all_background():
    labels = trimap(np.zeros((80, 90), dtype=np.bool_), NO_BONES, band=5)
    assert (labels == TrimapLabel.BACKGROUND).all()


@pytest.mark.parametrize(("width", "expected"), [(60, 4.0), (120, 6.0), (1000, 8.0)])
def test_the_first_band_is_5_percent_of_the_width_within_shares_of_the_body(
    width: int, expected: float
):
    silhouette = np.zeros((150, width), dtype=np.bool_)
    silhouette[20:120, 10:40] = True
    assert first_band(silhouette, NO_BONES) == pytest.approx(expected)


def test_the_bodys_size_counts_bones_beyond_the_silhouette():
    silhouette = np.zeros((100, 100), dtype=np.bool_)
    silhouette[10:30, 10:30] = True
    assert body_size(silhouette, NO_BONES) == 20
    assert body_size(silhouette, np.array([[[20.0, 20.0], [20.0, 90.0]]])) == 81


def test_the_picture_shows_three_greys():
    picture = trimap_picture(trimap(disc(60), NO_BONES, band=20))
    assert set(np.unique(picture)) == {0.0, 0.5, 1.0}
    assert picture[100, 120, 0] == 1.0
    assert picture[0, 0, 0] == 0.0


def test_bones_join_the_clicks_that_are_seen():
    clicks = {
        "left_shoulder": Click(x=10, y=20),
        "left_elbow": Click(x=12, y=40),
        "left_wrist": Click(x=14, y=60, occluded=True),
    }
    np.testing.assert_array_equal(clicked_bones(clicks), [[[10, 20], [12, 40]]])
    assert clicked_bones({}).shape == (0, 2, 2)


def test_every_bone_has_its_mirror_image():
    def mirrored(name: str) -> str:
        for one, other in (("left_", "right_"), ("right_", "left_")):
            if name.startswith(one):
                return other + name.removeprefix(one)
        return name

    bones = {frozenset(bone) for bone in BONES}
    assert {frozenset(map(mirrored, bone)) for bone in BONES} == bones
    assert len(bones) == len(BONES)


SEED = disc(60).astype(np.float32)
LIMB_WITHIN = np.array([[[100.0, 100.0], [140.0, 100.0]]])


def test_a_seeds_border_alone_is_open():
    labels = seeded_trimap(SEED, LIMB_WITHIN)
    assert labels is not None
    uncertain = is_uncertain(labels)
    assert not uncertain[disc(55)].any()
    assert not uncertain[~disc(65)].any()
    assert uncertain[disc(62) & ~disc(58)].all()


def test_a_person_before_any_cut_is_the_seed_with_the_clicked_bones():
    person = seeded_person(SEED, LIMB_WITHIN)
    assert person is not None
    assert (person >= (SEED > 0.5)).all()
    labels = seeded_trimap(SEED, LIMB_WITHIN)
    assert labels is not None
    assert person[labels == TrimapLabel.FOREGROUND].all()
    assert not person[labels == TrimapLabel.BACKGROUND].any()


def test_a_seed_that_leaves_out_a_clicked_limb_is_not_used():
    half_outside = np.array([[[120.0, 100.0], [220.0, 100.0]]])
    assert seeded_trimap(SEED, half_outside) is None
    assert seeded_trimap(SEED, NO_BONES) is None
    assert seeded_person(SEED, half_outside) is None
