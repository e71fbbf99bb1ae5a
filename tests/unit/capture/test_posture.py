"""Who sits, bends or lies, and who is a child."""

from dataclasses import replace

import numpy as np
import pytest

from fitter.capture.people import proportions
from fitter.capture.posture import detected_directions, posture
from fitter.detection.detector import DetectedBody, LimbSlant
from fitter.vocabulary.remarks import Code, Severity
from tests.unit.capture.made_up import by_points_alone, capture, is_unchecked, person

UP, DOWN, AWAY = np.array([[0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]])
ACROSS = np.array([1.0, 0.0, 0.0])


def posed(trunk: np.ndarray, thighs: np.ndarray, shins: np.ndarray) -> dict[str, np.ndarray]:
    limbs = {"thigh": thighs, "shin": shins}
    sided = {f"{side}_{limb}": at for side in ("left", "right") for limb, at in limbs.items()}
    return {"trunk": trunk, **sided}


def tilted(degrees: float) -> np.ndarray:
    """From downward toward the camera."""
    angle = np.radians(degrees)
    return np.cos(angle) * DOWN + np.sin(angle) * AWAY


@pytest.mark.parametrize(
    ("directions", "severity", "said"),
    [
        (posed(UP, tilted(85.0), DOWN), Severity.BLOCKS, "sits or crouches"),
        (posed(UP, tilted(85.0), tilted(80.0)), Severity.BLOCKS, "sits or bends the hips"),
        (posed(ACROSS, DOWN, DOWN), Severity.BLOCKS, "bends over"),
        (posed(UP, DOWN, tilted(-90.0)), Severity.BLOCKS, "kneels"),
        (posed(ACROSS, -ACROSS, -ACROSS), Severity.BLOCKS, "lies"),
        (posed(UP, tilted(42.0), tilted(40.0)), Severity.HARMS, "sits or bends the hips"),
        (posed(UP, tilted(25.0), tilted(7.0)), Severity.HARMS, "sits or crouches"),
        (posed(UP, tilted(31.0), tilted(6.0)), Severity.BLOCKS, "sits or crouches"),
    ],
)
def test_who_does_not_stand_is_told(directions, severity, said):
    told = posture(capture(directions=directions))
    assert told is not None
    assert (told.code, told.severity) == (Code.NOT_STANDING, severity)
    assert said in told.reason
    assert told.remedy


def test_who_stands_or_lifts_one_leg_stands():
    straight = posed(UP, DOWN, DOWN)
    assert posture(capture(directions=straight)) is None
    assert posture(capture(directions=posed(UP, tilted(15.0), tilted(-5.0)))) is None
    assert posture(capture(directions={**straight, "left_thigh": tilted(90.0)})) is None


def seen(sine: float) -> DetectedBody:
    """The person with thighs that slant so far from the picture, as a detector tells it."""
    body = person()
    limbs = {f"{side}_thigh": LimbSlant(sine=sine, sigma=0.1) for side in ("left", "right")}
    return replace(body, slants=replace(body.slants, limbs=limbs))


def test_before_a_fit_the_detectors_slants_tell():
    assert posture(capture(seen(0.1))) is None
    told = posture(capture(seen(-0.95)))
    assert told is not None
    assert told.severity is Severity.BLOCKS
    for direction in detected_directions(capture(seen(-0.95))).values():
        assert np.linalg.norm(direction) == pytest.approx(1.0)


def test_of_a_fit_the_detector_is_asked_too():
    """A body would rather stand than sit toward the camera."""
    told = posture(capture(seen(-0.95), directions=posed(UP, DOWN, DOWN)))
    assert told is not None
    assert told.severity is Severity.BLOCKS
    bent = posture(capture(seen(0.1), directions=posed(UP, tilted(42.0), tilted(40.0))))
    assert bent is not None
    assert bent.severity is Severity.HARMS


def test_a_thigh_that_looks_short_points_at_the_camera_whatever_its_slant():
    """The made-up trunk is 150 pixels long, thighs of 40 less than a half of the least."""
    short = {f"{side}_knee": (x, 330.0) for side, x in (("left", 230.0), ("right", 170.0))}
    body = replace(seen(-0.2), points=person(**short).points)
    told = posture(capture(body))
    assert told is not None
    assert told.severity is Severity.BLOCKS
    assert detected_directions(capture(body))["left_thigh"][2] < -0.8


def test_a_trunk_that_looks_short_is_bent_toward_the_camera():
    low = {f"{side}_shoulder": (x, 240.0) for side, x in (("left", 254.0), ("right", 146.0))}
    told = posture(capture(replace(seen(0.0), points=person(**low).points)))
    assert told is not None
    assert "bends over" in told.reason


@pytest.mark.parametrize(
    ("nose_y", "severity"), [(120.0, Severity.HARMS), (160.0, Severity.BLOCKS)]
)
def test_whose_head_hangs_bends_over(nose_y, severity):
    """The made-up shoulders are at 140, and the person 540 pixels tall."""
    low = replace(seen(0.0), points=person(nose=(200.0, nose_y)).points)
    assert posture(capture(low)) is None
    assert posture(capture(replace(seen(0.0), leaning_deg=60.0))) is None
    hanging = replace(low, leaning_deg=60.0)
    told = posture(capture(hanging))
    assert told is not None
    assert (told.code, told.severity) == (Code.NOT_STANDING, severity)
    assert "bends over" in told.reason
    assert posture(capture(hanging, directions=posed(UP, DOWN, DOWN))) == told


def with_the_left_leg_alone(body: DetectedBody) -> DetectedBody:
    """As from the side, where it hides the other."""
    limbs = {name: slant for name, slant in body.slants.limbs.items() if "left" in name}
    return replace(body, slants=replace(body.slants, limbs=limbs))


def test_of_who_is_seen_from_the_side_one_leg_tells():
    assert posture(capture(with_the_left_leg_alone(seen(0.1)))) is None
    told = posture(capture(with_the_left_leg_alone(seen(-0.95))))
    assert told is not None
    assert told.severity is Severity.BLOCKS


def test_without_thighs_nothing_is_told_of_the_posture():
    assert is_unchecked(posture(by_points_alone()))
    assert is_unchecked(proportions(by_points_alone()))


def test_children_are_told_by_their_eyes():
    assert proportions(capture(seen(0.0))) is None
    places = {"left_eye": (218.0, 72.0), "right_eye": (182.0, 72.0)}
    small = replace(seen(0.0), points=person(**places).points)
    told = proportions(capture(small))
    assert told is not None
    assert (told.code, told.severity) == (Code.CHILD, Severity.BLOCKS)
    assert "The eyes are 6." in told.reason


def test_of_who_sits_proportions_are_not_told():
    assert is_unchecked(proportions(capture(seen(-0.95))))
