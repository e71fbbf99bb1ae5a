"""How the camera was held: level, and far enough from the person."""

import math

import numpy as np

from fitter.capture.capture import Capture
from fitter.capture.finding import Code, Finding, Remark, Unchecked
from fitter.vocabulary.outcomes import Severity

MOST_ROLLED_DEG = 8.0
"""Of people who stand: their line from ankles to shoulders leans by at most 4.1 degrees on the
tuning pictures, most of it by shifting the hips."""

STRAIGHT_DEG = 20.0
"""Trunk and legs of who stands upright differ by less."""

NEAREST_M = 1.6
"""Nearer than this, what is nearer to the camera looks a tenth larger than what is farther."""


def roll(capture: Capture) -> Remark | None:
    """Whether a person who stands upright leans in the picture."""
    lean = lean_deg(capture)
    if lean is None:
        return Unchecked(
            code=Code.CAMERA_ROLLED,
            reason="Nobody is seen to stand upright from ankles to shoulders.",
        )
    if abs(lean) <= MOST_ROLLED_DEG:
        return None
    return Finding(
        code=Code.CAMERA_ROLLED,
        severity=Severity.HARMS,
        reason=(
            f"From ankles to shoulders the person leans by {abs(lean):.0f} degrees to the "
            f"{'right' if lean > 0.0 else 'left'} of the picture, and {MOST_ROLLED_DEG:.0f} are "
            "the most."
        ),
        remedy="Hold the camera level and have the person stand upright.",
        points=("left_shoulder", "right_shoulder", "left_ankle", "right_ankle"),
    )


def lean_deg(capture: Capture) -> float | None:
    """How far the line from ankles to shoulders leans to the right, degrees in (-180, 180].

    None if it is not known, or trunk and legs do not point the same way.
    """
    shoulders, hips = capture.middle("shoulder"), capture.middle("hip")
    ankles = capture.middle("ankle")
    if shoulders is None or hips is None or ankles is None:
        return None
    trunk, legs = shoulders - hips, hips - ankles
    bent = _angle_deg(trunk) - _angle_deg(legs)
    if abs((bent + 180.0) % 360.0 - 180.0) > STRAIGHT_DEG:
        return None
    return _angle_deg(shoulders - ankles)


def distance(capture: Capture) -> Remark | None:
    """Whether the camera was too near."""
    distance_m = camera_distance_m(capture)
    if distance_m is None:
        reason = (
            "Neither the request nor the picture's EXIF data names a focal length."
            if capture.focal_length_px is None
            else "How tall the person is in the picture is not known without hips and ankles."
        )
        return Unchecked(code=Code.CAMERA_TOO_NEAR, reason=reason)
    if distance_m >= NEAREST_M:
        return None
    return Finding(
        code=Code.CAMERA_TOO_NEAR,
        severity=Severity.HARMS,
        reason=(
            f"By the focal length and a height of {capture.height_m:.2f} m the camera was "
            f"{distance_m:.1f} m from the person, and {NEAREST_M:.1f} m is the least."
        ),
        remedy=(
            "Step back to 2.5 m or more and zoom in; if the picture was cropped, send the focal "
            "length in its own pixels."
        ),
    )


def camera_distance_m(capture: Capture) -> float | None:
    """From the camera to the person, metres; None if lens or stature are not known."""
    if capture.focal_length_px is None or capture.stature_px is None:
        return None
    return capture.focal_length_px * capture.height_m / capture.stature_px


def _angle_deg(direction: np.ndarray) -> float:
    """Clockwise from upright."""
    return math.degrees(math.atan2(float(direction[0]), -float(direction[1])))
