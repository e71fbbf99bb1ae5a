"""Skin found on drawn people whose every pixel is known."""

import numpy as np
import pytest

from fitter.segmentation.skin_colour import PersonRegions, SkinMap, face_point, skin_map

PARTS = ("head", "chest", "left_forearm", "left_hand", "pelvis")
SKIN, SHADED_SKIN, HAIR = (0.5, 0.3, 0.2), (0.1, 0.06, 0.04), (0.02, 0.015, 0.01)
HEIGHT, WIDTH = 200, 100
FACE = np.array([50.0, 30.0])

REGIONS = {
    "hair": (slice(5, 15), slice(38, 62)),
    "face": (slice(15, 45), slice(38, 62)),
    "chest": (slice(45, 110), slice(25, 75)),
    "forearm": (slice(45, 90), slice(8, 22)),
    "hand": (slice(90, 110), slice(8, 22)),
    "pelvis": (slice(110, 180), slice(25, 75)),
}
PART_OF = {"hair": 0, "face": 0, "chest": 1, "forearm": 2, "hand": 3, "pelvis": 4}


def drawn(colours: dict[str, tuple[float, float, float]]) -> tuple[np.ndarray, PersonRegions]:
    """A person of boxes with some noise; parts are known but for a few pixels beyond each."""
    picture = np.full((HEIGHT, WIDTH, 3), 0.35)
    parts = np.full((HEIGHT, WIDTH), -1)
    person = np.zeros((HEIGHT, WIDTH), dtype=bool)
    for name, colour in colours.items():
        picture[REGIONS[name]] = colour
        person[REGIONS[name]] = True
        rows, columns = REGIONS[name]
        inner = slice(rows.start + 2, rows.stop - 2), slice(columns.start + 2, columns.stop - 2)
        parts[inner] = PART_OF[name]
    noise = np.random.default_rng(7).normal(scale=0.03, size=picture.shape)
    regions = PersonRegions(
        person=person, parts=parts, part_names=PARTS, face=FACE, pixels_per_metre=300.0
    )
    return np.clip(picture * (1.0 + noise), 0.0, 1.0), regions


def within(skin: SkinMap, name: str) -> float:
    """Mean probability away from the borders of a region."""
    rows, columns = REGIONS[name]
    return float(
        skin.probability[
            rows.start + 5 : rows.stop - 5, columns.start + 5 : columns.stop - 5
        ].mean()
    )


def person(chest, forearm=SKIN, hand=SKIN, pelvis=(0.03, 0.05, 0.15)):
    return drawn(
        {
            "hair": HAIR, "face": SKIN, "chest": chest, "forearm": forearm, "hand": hand,
            "pelvis": pelvis,
        }
    )  # fmt: skip


@pytest.mark.parametrize("shirt", [(0.5, 0.5, 0.5), (0.1, 0.2, 0.4), (0.02, 0.02, 0.02)])
def test_a_shirt_is_cloth_and_face_and_forearm_are_skin(shirt):
    skin = skin_map(*person(shirt))
    assert skin.learnt_from == ("face", "hands")
    assert within(skin, "face") > 0.9
    assert within(skin, "forearm") > 0.9
    assert within(skin, "chest") < 0.1
    assert within(skin, "pelvis") < 0.1


def test_skin_in_shade_is_skin():
    skin = skin_map(*person((0.5, 0.5, 0.5), forearm=SHADED_SKIN))
    assert within(skin, "forearm") > 0.8


def test_a_bare_chest_is_skin_although_chests_seldom_are():
    skin = skin_map(*person(SKIN))
    assert within(skin, "chest") > 0.8
    assert within(skin, "pelvis") < 0.1


def test_what_has_the_skin_s_colour_does_not_depend_on_the_part():
    skin = skin_map(*person((0.1, 0.2, 0.4), pelvis=SKIN))
    assert skin.coloured[REGIONS["pelvis"]].mean() > 0.9
    assert skin.coloured[REGIONS["forearm"]].mean() > 0.9
    assert skin.coloured[REGIONS["chest"]].mean() < 0.05
    assert not skin.coloured[:, 80:].any()


def test_a_gloved_hand_does_not_teach_the_skin():
    skin = skin_map(*person((0.5, 0.5, 0.5), hand=(0.02, 0.2, 0.03)))
    assert skin.learnt_from == ("face",)
    assert within(skin, "hand") < 0.5
    assert within(skin, "forearm") > 0.9


def masked(colour: tuple[float, float, float], **colours: tuple[float, float, float]):
    """The face is hidden from the nose down."""
    picture, regions = person((0.03, 0.05, 0.15), **colours)
    rows, columns = REGIONS["face"]
    picture[rows.start + 11 : rows.stop, columns] = colour
    return picture, regions


@pytest.mark.parametrize("mask", [(0.6, 0.6, 0.58), (0.33, 0.47, 0.56), (0.025, 0.025, 0.028)])
def test_under_a_mask_the_skin_has_the_hand_s_colour(mask):
    skin = skin_map(*masked(mask))
    assert skin.learnt_from == ("face", "hands")
    assert within(skin, "forearm") > 0.9
    assert within(skin, "chest") < 0.1


def test_a_glove_of_no_colour_that_the_face_shows_does_not_take_its_place():
    skin = skin_map(*masked((0.6, 0.6, 0.58), hand=(0.3, 0.04, 0.05), pelvis=(0.3, 0.04, 0.05)))
    assert skin.learnt_from == ("face",)
    assert within(skin, "pelvis") < 0.1


def test_hair_beside_the_face_does_not_teach_the_skin():
    picture, regions = person((0.02, 0.015, 0.012))
    nearer_hair = PersonRegions(
        person=regions.person,
        parts=regions.parts,
        part_names=PARTS,
        face=np.array([50.0, 20.0]),
        pixels_per_metre=300.0,
    )
    assert within(skin_map(picture, nearer_hair), "chest") < 0.2


def test_without_face_and_hands_the_trunk_is_covered_and_the_head_is_bare():
    picture, regions = drawn({"chest": SKIN, "pelvis": SKIN, "face": SKIN})
    unseen = PersonRegions(
        person=regions.person,
        parts=regions.parts,
        part_names=PARTS,
        face=None,
        pixels_per_metre=300.0,
    )
    skin = skin_map(picture, unseen)
    assert skin.learnt_from == ()
    assert not skin.coloured.any()
    assert within(skin, "chest") < 0.02
    assert within(skin, "face") == pytest.approx(0.8, abs=0.02)


def test_off_the_person_the_map_goes_on_from_the_nearest_pixel():
    skin = skin_map(*person((0.1, 0.2, 0.4)))
    assert skin.probability[75, 95] < 0.1
    assert skin.probability[60, 2] > 0.9


def test_the_face_is_where_it_was_clicked_or_else_where_a_body_shows_its_nose():
    clicked = np.array([[10.0, 20.0], [14.0, 20.0]])
    np.testing.assert_array_equal(face_point(clicked, np.zeros(2)), [12.0, 20.0])
    np.testing.assert_array_equal(face_point(np.empty((0, 2)), np.ones(2)), [1.0, 1.0])
    assert face_point(np.empty((0, 2)), None) is None


def test_a_picture_without_colours_teaches_none():
    """Cloth as bright as the face would pass for skin."""
    picture, regions = person(chest=(0.3, 0.36, 0.42))
    assert skin_map(picture, regions).learnt_from == ("face", "hands")
    grey = np.repeat(picture.mean(axis=2, keepdims=True), 3, axis=2)
    skin = skin_map(grey, regions)
    assert skin.learnt_from == ()
    assert not skin.coloured.any()
    assert within(skin, "chest") < 0.2
    assert within(skin, "face") > 0.6
