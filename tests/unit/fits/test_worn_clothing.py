"""How regions are told to be covered."""

from dataclasses import replace

import numpy as np
import pytest

from fitter.fits.clothing_report import worn_regions
from fitter.segmentation.coverage import Coverage
from fitter.segmentation.skin_colour import PersonRegions, SkinMap
from fitter.vocabulary.choices import BodyRegion, Covering

PARTS = ("head", "chest", "left_upper_arm", "pelvis", "left_thigh", "left_shin", "left_foot")
SIDE = 20
"""Pixels of a part each way; the parts lie side by side."""

NOTHING = np.zeros((SIDE, SIDE * len(PARTS)), dtype=np.bool_)
NO_SKIN = SkinMap(probability=NOTHING.astype(np.float32), coloured=NOTHING, learnt_from=())
COVERED = Coverage(top=1.0, bottom=1.0, top_like_skin=0.0, bottom_like_skin=0.0)


def regions(unseen: tuple[str, ...] = ()) -> PersonRegions:
    parts = np.repeat(np.arange(len(PARTS)), SIDE)[None].repeat(SIDE, axis=0)
    return PersonRegions(
        person=~np.isin(parts, [PARTS.index(name) for name in unseen]),
        parts=parts,
        part_names=PARTS,
        face=None,
        pixels_per_metre=300.0,
    )


def of_parts(**values: float) -> np.ndarray:
    """(h, w) a value for each part, 0 where none is said."""
    of_part = np.array([values.get(name, 0.0) for name in PARTS], dtype=np.float32)
    return of_part[regions().parts]


def kinds(bare: np.ndarray, loose: np.ndarray) -> dict[BodyRegion, Covering]:
    found = worn_regions(regions(), NO_SKIN, COVERED, bare=bare, loose=loose)
    return {each.region: each.kind for each in found}


def test_a_shirt_above_leggings():
    found = kinds(of_parts(left_upper_arm=0.9), of_parts(chest=0.9, left_upper_arm=0.9))
    assert found == {
        BodyRegion.UPPER: Covering.LOOSE,
        BodyRegion.ARMS: Covering.BARE,
        BodyRegion.LOWER: Covering.CLOSE,
        BodyRegion.LEGS: Covering.CLOSE,
        BodyRegion.FEET: Covering.CLOSE,
    }


def test_shoes_are_never_loose():
    everything = np.ones((SIDE, SIDE * len(PARTS)), dtype=np.float32)
    assert kinds(0.0 * everything, everything)[BodyRegion.FEET] is Covering.CLOSE


def test_people_in_underwear_are_bare_as_probably_as_nothing_covers_them():
    covered = Coverage(top=0.1, bottom=0.2, top_like_skin=0.0, bottom_like_skin=0.0)
    found = worn_regions(regions(), NO_SKIN, covered, bare=None, loose=None)
    told = {each.region: each.probability for each in found}
    assert {each.kind for each in found} == {Covering.BARE}
    assert told[BodyRegion.UPPER] == pytest.approx(0.9)
    assert told[BodyRegion.LEGS] == pytest.approx(0.8)


def test_of_what_is_out_of_sight_nothing_is_told():
    found = worn_regions(regions(unseen=("left_shin",)), NO_SKIN, COVERED, bare=None, loose=None)
    assert BodyRegion.LEGS not in {each.region for each in found}


@pytest.mark.parametrize(
    ("skin_share", "kind", "probability"),
    [(0.6, Covering.BARE, 0.6), (0.2, Covering.LOOSE, 0.8)],
    ids=["face", "hair or a hat"],
)
def test_heads_are_covered_where_little_skin_shows(skin_share, kind, probability):
    rows = np.arange(SIDE)[:, None] < round(skin_share * SIDE)
    skin = replace(NO_SKIN, coloured=rows & (regions().parts == 0), learnt_from=("face",))
    found = worn_regions(regions(), skin, COVERED, bare=None, loose=None)
    (head,) = [each for each in found if each.region is BodyRegion.HEAD]
    assert head.kind is kind
    assert head.probability == pytest.approx(probability)
