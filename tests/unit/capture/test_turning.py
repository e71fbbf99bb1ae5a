"""From where a person is seen."""

import math

import pytest

from fitter.capture.posture import announced_view, facing, seen_from
from fitter.vocabulary.choices import ViewKind
from fitter.vocabulary.outcomes import SeenFrom
from fitter.vocabulary.remarks import Code, Severity
from tests.unit.capture.made_up import (
    FRONT,
    by_points_alone,
    capture,
    is_finding,
    is_unchecked,
    person,
)


def turned(degrees: float) -> dict[str, tuple[float, float]]:
    """Shoulders and hips of the person who faces the camera, turned about the upright axis."""
    shrink = math.cos(math.radians(degrees))
    return {
        name: (200 + shrink * (x - 200), y)
        for name, (x, y) in FRONT.items()
        if "shoulder" in name or "hip" in name
    }


@pytest.mark.parametrize("degrees", [20.0, 45.0, 70.0, 90.0, 110.0, 150.0, 180.0])
def test_how_far_a_trunk_is_turned_is_found_from_its_breadth(degrees):
    cosine = facing(capture(person(**turned(degrees))))
    assert cosine is not None
    assert math.degrees(math.acos(cosine)) == pytest.approx(degrees, abs=8.0)


def test_a_roll_of_the_camera_turns_nobody():
    rolled = {name: (640.0 - y, x) for name, (x, y) in FRONT.items()}
    assert facing(capture(person(**rolled))) == pytest.approx(facing(capture()))


@pytest.mark.parametrize(
    ("degrees", "seen"),
    [
        (0.0, SeenFrom.FRONT),
        (35.0, SeenFrom.FRONT),
        (58.0, SeenFrom.BETWEEN),
        (80.0, SeenFrom.SIDE),
        (100.0, SeenFrom.SIDE),
        (122.0, SeenFrom.BETWEEN),
        (150.0, SeenFrom.BACK),
    ],
)
def test_views_have_names(degrees, seen):
    assert seen_from(math.cos(math.radians(degrees))) is seen


@pytest.mark.parametrize(
    ("view", "degrees", "severity"),
    [
        (ViewKind.FRONT, 10.0, None),
        (ViewKind.SIDE, 85.0, None),
        (ViewKind.BACK, 175.0, None),
        (ViewKind.OTHER, 60.0, None),
        (None, 60.0, None),
        (ViewKind.FRONT, 60.0, Severity.HARMS),
        (ViewKind.FRONT, 90.0, Severity.BLOCKS),
        (ViewKind.FRONT, 180.0, Severity.BLOCKS),
        (ViewKind.SIDE, 0.0, Severity.BLOCKS),
        (ViewKind.BACK, 0.0, Severity.BLOCKS),
    ],
)
def test_a_view_other_than_was_said_is_told(view, degrees, severity):
    found = announced_view(capture(person(**turned(degrees)), view=view))
    if severity is None:
        assert found is None
        return
    assert found is not None
    assert (found.code, found.severity) == (Code.OTHER_VIEW, severity)


def test_points_alone_tell_the_view_and_half_a_trunk_does_not():
    assert is_finding(announced_view(by_points_alone(view=ViewKind.SIDE)))
    half = {name: at for name, at in by_points_alone().points.items() if "left" in name}
    assert is_unchecked(announced_view(by_points_alone(view=ViewKind.SIDE, points=half)))
