"""How regions are told to be covered."""

import numpy as np
import pytest

from fitter.fits.worn_clothing import worn_regions
from fitter.segmentation.coverage import Coverage
from fitter.segmentation.skin_colour import PersonRegions
from fitter.vocabulary.choices import BodyRegion, Covering

PARTS = ("chest", "left_upper_arm", "pelvis", "left_thigh", "left_shin", "left_foot")
SIDE = 20
"""Pixels of a part each way; the parts lie side by side."""

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
    found = worn_regions(regions(), COVERED, bare=bare, loose=loose)
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
    found = worn_regions(regions(), covered, bare=None, loose=None)
    told = {each.region: each.probability for each in found}
    assert {each.kind for each in found} == {Covering.BARE}
    assert told[BodyRegion.UPPER] == pytest.approx(0.9)
    assert told[BodyRegion.LEGS] == pytest.approx(0.8)


def test_of_what_is_out_of_sight_nothing_is_told():
    found = worn_regions(regions(unseen=("left_shin",)), COVERED, bare=None, loose=None)
    assert BodyRegion.LEGS not in {each.region for each in found}
