"""When something before a person or beside them is told, on a drawn box for a body."""

import re

import numpy as np
import pytest

from fitter.evidence.silhouette_evidence import silhouette_evidence
from fitter.fits.verdict import LEAST_OFF_M2, nearest_parts, obstruction
from fitter.vocabulary.remarks import Code, Remark, Severity
from tests.unit.evidence.drawn_pictures import HEIGHT, PIXELS_PER_METRE, WIDTH, boxes

LEFT, RIGHT = 130, 190
RENDERING, _ = boxes((LEFT, RIGHT))
BODY = RENDERING.silhouette
PART_NAMES = ("head", "chest", "pelvis", "left_thigh", "left_shin", "left_foot", "left_forearm")
BORDERS = (40, 60, 100, 120, 160, 180, 201)
"""Rows at which the body's parts begin, from head to foot."""

rows, columns = np.indices((HEIGHT, WIDTH))


def block(top: int, bottom: int, left: int, right: int) -> np.ndarray:
    return (rows >= top) & (rows < bottom) & (columns >= left) & (columns < right)


def part_of_triangle(*, arms: bool = False) -> np.ndarray:
    """By the rows of the triangles; with ``arms`` the whole box is one."""
    if arms:
        return np.full(len(RENDERING.triangles), PART_NAMES.index("left_forearm"))
    middles = RENDERING.projected[RENDERING.triangles][..., 1].mean(axis=1)
    return np.clip(np.searchsorted(BORDERS, middles, side="right") - 1, 0, len(BORDERS) - 2)


def told(mask: np.ndarray, doubted: np.ndarray, *, arms: bool = False) -> Remark | None:
    found = obstruction(
        silhouette_evidence(mask).doubting(doubted),
        RENDERING,
        nearest_parts(RENDERING, part_of_triangle(arms=arms), PART_NAMES),
    )
    assert len(found) <= 1
    return found[0] if found else None


def shares(finding: Remark) -> dict[str, int]:
    return {part: int(share) for share, part in re.findall(r"(\d+) % at the (\w+)", finding.reason)}


def test_of_an_outline_that_is_not_doubted_nothing_is_told():
    thing = block(80, 140, 100, 220)
    assert told(BODY | thing, np.zeros_like(BODY)) is None


def test_a_thing_before_the_hips_is_told_with_the_parts_that_it_hides():
    thing = block(90, 125, 100, 220)
    finding = told(BODY | thing, block(90, 125, 90, 230))
    assert finding is not None
    assert (finding.code, finding.severity) == (Code.COVERED, Severity.HARMS)
    assert "before the person or beside them" in finding.remedy
    found = shares(finding)
    assert found.keys() == {"trunk", "hips", "thighs"}
    assert found["hips"] == 100
    assert found["trunk"] == pytest.approx(25, abs=2)
    assert found["thighs"] == pytest.approx(12, abs=2)


def test_what_sticks_out_less_than_the_bound_is_not_told():
    least_px = LEAST_OFF_M2 * PIXELS_PER_METRE**2
    broad = 20
    tall = int(least_px / broad)
    doubted = block(60, 180, 90, 230)
    for rows_more, is_told in ((-4, False), (4, True)):
        # The first 4 columns are within what a body may be off.
        thing = block(80, 80 + tall + rows_more, RIGHT, RIGHT + 4 + broad)
        assert (told(BODY | thing, doubted) is not None) is is_told


def test_doubt_that_spread_from_a_shadow_at_the_feet_is_not_told():
    shadow = block(185, 200, 60, 260)
    assert told(BODY | shadow, block(60, 200, 60, 260)) is None


def test_what_hides_a_leg_is_told_and_an_arm_where_none_is_seen_is_not():
    gap = block(120, 160, 120, 170)
    doubted = block(110, 170, 110, 200)
    finding = told(BODY & ~gap, doubted)
    assert finding is not None
    assert "thighs" in shares(finding)
    assert told(BODY & ~gap, doubted, arms=True) is None


def test_a_part_of_whose_outline_hardly_anything_is_doubted_is_not_named():
    thing = block(118, 160, 100, 220)
    finding = told(BODY | thing, block(119, 160, 90, 230))
    assert finding is not None
    assert shares(finding).keys() == {"thighs", "hips"}
    finding = told(BODY | thing, block(120, 160, 90, 230))
    assert finding is not None
    assert shares(finding).keys() == {"thighs"}
