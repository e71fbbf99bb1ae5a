"""Level and far enough."""

import math

import numpy as np
import pytest

from fitter.capture.framing import (
    MOST_ROLLED_DEG,
    NEAREST_M,
    camera_distance_m,
    distance,
    lean_deg,
    roll,
)
from fitter.vocabulary.remarks import Code
from tests.unit.capture.made_up import (
    FRONT,
    STATURE_PX,
    by_points_alone,
    capture,
    is_unchecked,
    person,
)


def rolled(degrees: float) -> dict[str, tuple[float, float]]:
    """The person's points turned clockwise about the hips."""
    angle = math.radians(degrees)
    cosine, sine = math.cos(angle), math.sin(angle)
    return {
        name: (
            200 + cosine * (x - 200) - sine * (y - 290),
            290 + sine * (x - 200) + cosine * (y - 290),
        )
        for name, (x, y) in FRONT.items()
    }


@pytest.mark.parametrize("degrees", [-170.0, -20.0, 0.0, 5.0, 12.0, 90.0])
def test_a_roll_of_the_camera_leans_whoever_stands(degrees):
    assert lean_deg(capture(person(**rolled(degrees)))) == pytest.approx(degrees, abs=0.01)


def test_more_than_so_many_degrees_are_told_with_their_side():
    within, beyond = MOST_ROLLED_DEG - 0.5, MOST_ROLLED_DEG + 1.0
    assert roll(capture(person(**rolled(within)))) is None
    found = roll(capture(person(**rolled(beyond))))
    assert found is not None
    assert (found.code, "to the right" in found.reason) == (Code.CAMERA_ROLLED, True)
    other = roll(capture(person(**rolled(-beyond))))
    assert other is not None
    assert "to the left" in other.reason


def test_whoever_bends_or_sits_tells_nothing_of_the_camera():
    bent = {name: (x + 120, y) for name, (x, y) in FRONT.items() if "shoulder" in name}
    assert is_unchecked(roll(capture(person(**bent))))


def test_the_distance_follows_from_lens_and_stature():
    """By similar triangles: f / distance = pixels / metres."""
    assert camera_distance_m(capture()) == pytest.approx(900.0 * 1.7 / STATURE_PX, rel=0.01)
    near = 0.9 * NEAREST_M * STATURE_PX / 1.7
    for make in (capture, by_points_alone):
        assert distance(make()) is None
        found = distance(make(focal_length_px=near))
        assert found is not None
        assert (found.code, "1.4 m from" in found.reason) == (Code.CAMERA_TOO_NEAR, True)


def test_without_a_focal_length_or_a_stature_nobody_knows_the_distance():
    for unknown in (
        capture(focal_length_px=None),
        by_points_alone(points={"nose": person().points["nose"]}),
    ):
        told = distance(unknown)
        assert is_unchecked(told)
        assert told.code == Code.CAMERA_TOO_NEAR
    assert np.isfinite(NEAREST_M)
