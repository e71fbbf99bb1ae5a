"""Pictures that were squeezed or stretched, by heads that are too broad or too narrow."""

import pytest

from fitter.fits.verdict import BROAD_HEAD, EARS, NARROW_HEAD, squeezed
from fitter.vocabulary.remarks import Code, Severity
from tests.unit.capture.made_up import STATURE_PX, capture, person

BROAD, NARROW = 1.1 * EARS * STATURE_PX, 0.9 * EARS * STATURE_PX


def told(breadth: float | None, ears_px: float, *, shoulder_px: float = 124.0) -> str | None:
    half = 0.5 * ears_px
    shown = person(
        left_ear=(200.0 + half, 76.0),
        right_ear=(200.0 - half, 76.0),
        left_shoulder=(200.0 + 0.5 * shoulder_px, 140.0),
        right_shoulder=(200.0 - 0.5 * shoulder_px, 140.0),
    )
    found = squeezed(capture(shown), breadth)
    assert all((each.code, each.severity) == (Code.SQUEEZED, Severity.HARMS) for each in found)
    return found[0].reason if found else None


def test_head_and_ears_that_are_both_too_broad_or_both_too_narrow_are_told():
    assert "squeezed" in (told(BROAD_HEAD + 0.01, BROAD) or "")
    assert "stretched" in (told(NARROW_HEAD - 0.01, NARROW) or "")


@pytest.mark.parametrize(
    ("breadth", "ears_px"),
    [
        (1.0, BROAD),
        (1.0, NARROW),
        # Long hair, and a mask that misses a part of the head.
        (BROAD_HEAD + 0.1, NARROW),
        (NARROW_HEAD - 0.1, BROAD),
        (None, BROAD),
        (0.0, NARROW),
    ],
)
def test_one_of_them_alone_is_not(breadth, ears_px):
    assert told(breadth, ears_px) is None


def test_of_who_is_seen_from_the_side_nothing_is_said():
    assert told(BROAD_HEAD + 0.1, BROAD, shoulder_px=4.0) is None
