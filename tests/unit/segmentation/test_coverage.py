"""What people wear, told by how much of each region shows their skin's colour."""

from dataclasses import replace

import numpy as np
import pytest

from fitter.segmentation.coverage import Coverage, coverage, region_means
from fitter.segmentation.skin_colour import PersonRegions, SkinMap

PARTS = (
    "head", "chest", "spine", "pelvis", "left_thigh", "right_thigh", "left_shin", "right_shin",
    "left_upper_arm",
)  # fmt: skip
SIDE = 20
"""Pixels of a part each way; the parts lie side by side."""

UNDERWEAR = {"head": 0.8, "chest": 0.9, "spine": 0.7, "thigh": 0.5, "shin": 0.9, "upper_arm": 0.9}
SHIRT_AND_TROUSERS = {"head": 0.8, "chest": 0.08, "upper_arm": 0.3}


def shown(shares: dict[str, float], unseen: tuple[str, ...] = ()) -> tuple[SkinMap, PersonRegions]:
    """Parts of which a share has the skin's colour."""
    parts = np.repeat(np.arange(len(PARTS)), SIDE)[None].repeat(SIDE, axis=0)
    person = ~np.isin(parts, [PARTS.index(name) for name in unseen])
    coloured = np.zeros(parts.shape, dtype=np.bool_)
    for number, name in enumerate(PARTS):
        rows = round(shares.get(name.removeprefix("left_").removeprefix("right_"), 0.0) * SIDE)
        coloured[:rows] |= parts[:rows] == number
    skin = SkinMap(
        probability=(coloured & person).astype(np.float32),
        coloured=coloured & person,
        learnt_from=("face",),
    )
    regions = PersonRegions(
        person=person, parts=parts, part_names=PARTS, face=None, pixels_per_metre=300.0
    )
    return skin, regions


def of(
    shares: dict[str, float], gender: str = "male", seen: dict[str, float] | None = None
) -> Coverage:
    """Coverage by colours, and by what a network sees, if it was asked."""
    skin, regions = shown(shares)
    if seen is not None:
        skin = replace(skin, probability=shown(seen)[0].probability, by_network=True)
    return coverage(skin, regions, gender)


@pytest.mark.parametrize(
    ("gender", "chest"), [("male", 0.9), ("female", 0.5)], ids=["man", "woman"]
)
def test_people_in_underwear_are_not_covered(gender, chest):
    assert of(UNDERWEAR | {"chest": chest}, gender).anything < 0.05


def test_poor_light_covers_nobody():
    in_shadow = {"head": 0.6, "chest": 0.5, "spine": 0.3, "thigh": 0.2, "shin": 0.4}
    assert of(in_shadow, "female").anything < 0.3


@pytest.mark.parametrize("gender", ["male", "female"])
def test_a_shirt_with_trousers_covers_both(gender):
    found = of(SHIRT_AND_TROUSERS, gender)
    assert min(found.top, found.bottom) > 0.99


def test_shorts_or_a_dress_cover_although_shins_are_bare():
    found = of({"head": 0.8, "chest": 0.15, "thigh": 0.1, "shin": 0.9}, "female")
    assert min(found.top, found.bottom) > 0.99


def test_a_bare_chest_above_trousers_is_bare():
    found = of({"head": 0.8, "chest": 0.9, "spine": 0.8})
    assert found.top < 0.5
    assert found.bottom > 0.95


def test_a_bare_chest_above_swim_trunks_is_bare():
    found = of({"head": 0.8, "chest": 0.98, "spine": 0.98, "thigh": 0.1, "shin": 0.9})
    assert found.top < 0.1
    assert found.bottom > 0.7


def test_a_man_s_top_of_the_skin_s_colour_is_a_top_where_it_hangs_over_his_hips():
    found = of({"head": 0.8, "chest": 0.98, "spine": 0.98, "pelvis": 0.8})
    assert found.top_like_skin > 0.7


def test_a_woman_s_top_of_the_skin_s_colour_is_a_top():
    found = of({"head": 0.8, "chest": 0.98, "spine": 0.95, "pelvis": 0.9}, "female")
    assert found.top_like_skin > 0.9


BEIGE_CLOTHES = {"head": 0.8, "chest": 0.6, "spine": 0.6, "pelvis": 0.6, "thigh": 0.6}


def test_clothes_of_the_skin_s_colour_in_which_a_network_sees_no_skin_cover():
    assert of(BEIGE_CLOTHES).anything < 0.5
    found = of(BEIGE_CLOTHES, seen={"head": 0.8})
    assert min(found.top, found.bottom) > 0.8


def test_little_skin_for_a_network_does_not_dress_who_shows_its_colour():
    little = {"head": 0.8, "chest": 0.2, "spine": 0.15, "thigh": 0.2}
    assert of(UNDERWEAR, seen=little).anything < 0.2


def test_below_a_top_a_network_tells_skin_whatever_its_colour():
    skin, regions = shown({"head": 0.8, "chest": 0.95, "spine": 0.95, "pelvis": 0.9})
    dressed = Coverage(top=1.0, bottom=1.0, top_like_skin=1.0, bottom_like_skin=0.0)
    waist = regions.parts == PARTS.index("spine")
    assert dressed.bare(skin, regions)[waist].max() < 0.2
    assert dressed.bare(replace(skin, by_network=True), regions)[waist].max() == 1.0


def test_without_colours_trunk_and_legs_are_taken_to_be_covered():
    skin, regions = shown(UNDERWEAR)
    grey = coverage(replace(skin, learnt_from=()), regions, "male")
    assert (grey.top, grey.bottom, grey.top_like_skin) == (1.0, 1.0, 0.0)


def test_parts_out_of_sight_have_no_share():
    skin, regions = shown(UNDERWEAR, unseen=("left_thigh", "right_thigh", "spine"))
    shares = region_means(skin.coloured, regions)
    assert "thighs" not in shares
    assert "waist" not in shares
    assert shares["chest"] == pytest.approx(0.9)


def test_underwear_is_bare_although_it_is_not_skin():
    skin, regions = shown(UNDERWEAR)
    bare = coverage(skin, regions, "male").bare(skin, regions)
    assert bare[regions.parts == PARTS.index("pelvis")].min() > 0.95


def test_below_a_sleeve_an_arm_is_bare_where_it_shows_skin():
    skin, regions = shown(SHIRT_AND_TROUSERS)
    bare = coverage(skin, regions, "male").bare(skin, regions)
    arm = regions.parts == PARTS.index("left_upper_arm")
    assert bare[arm & skin.coloured].min() > 0.95
    assert bare[arm & ~skin.coloured].max() < 0.05


def test_skin_is_not_believed_in_the_midst_of_a_shirt():
    skin, regions = shown(SHIRT_AND_TROUSERS | {"spine": 0.1})
    bare = coverage(skin, regions, "male").bare(skin, regions)
    waist = regions.parts == PARTS.index("spine")
    assert bare[waist].max() < 0.2


@pytest.mark.parametrize("gender", ["male", "female"])
@pytest.mark.parametrize("legs", [{}, {"thigh": 0.1, "shin": 0.9}], ids=["trousers", "shorts"])
def test_a_midriff_under_an_open_vest_is_bare(gender, legs):
    skin, regions = shown({"head": 0.8, "chest": 0.25, "spine": 0.85, "upper_arm": 0.9} | legs)
    bare = coverage(skin, regions, gender).bare(skin, regions)
    waist = regions.parts == PARTS.index("spine")
    assert bare[waist & skin.coloured].min() > 0.5
    assert bare[waist & ~skin.coloured].max() < 0.2


def test_hips_under_a_shirt_of_the_skin_s_colour_are_not_bare():
    shirt = {"head": 0.8, "chest": 0.98, "spine": 0.95, "pelvis": 0.7}
    skin, regions = shown(shirt)
    found = coverage(skin, regions, "female")
    assert found.bottom > 0.9
    assert found.bare(skin, regions)[regions.parts == PARTS.index("pelvis")].max() < 0.2
