"""Whether the person stands: who sits, crouches, lies or bends over is not measured well."""

import numpy as np
from jaxtyping import Float

from fitter.capture.capture import Capture
from fitter.capture.finding import Code, Finding, Remark, Unchecked
from fitter.capture.joints import Directions
from fitter.vocabulary.outcomes import Severity

BENT_DEG, FOLDED_DEG = 35.0, 50.0
"""Both thighs turned from the trunk by more than the first make girths of waist and hips doubtful;
from the second on nobody stands. It is 20 degrees at most of 105 people who stand or stride, 29 of
a weightlifter."""

LEAST_THIGH = 0.61
"""Length of a thigh in the picture, of the trunk's: the least of 113 who stand or stride. One that
looks shorter points toward the camera or away from it, more than the detector's slants dare say."""

LYING_DEG = 55.0
"""How far the trunk of who lies is from the vertical, at least."""

_KNEES_DEG = 50.0


def posture(capture: Capture) -> Remark | None:
    """Whether trunk and thighs are in one line, and upright."""
    directions = detected_directions(capture) if capture.directions is None else capture.directions
    trunk = directions.get("trunk")
    hips = [
        angle_deg(-trunk, directions[name])
        for name in ("left_thigh", "right_thigh")
        if trunk is not None and name in directions
    ]
    if trunk is None or len(hips) < 2:
        return Unchecked(code=Code.NOT_STANDING, reason="Trunk and thighs are not both seen.")
    bent = min(hips)
    leaning = angle_deg(np.array([0.0, -1.0, 0.0]), trunk)
    lies = leaning > LYING_DEG and bent < FOLDED_DEG
    if bent < BENT_DEG and not lies:
        return None
    return Finding(
        code=Code.NOT_STANDING,
        severity=Severity.BLOCKS if lies or bent >= FOLDED_DEG else Severity.HARMS,
        reason=(
            f"The person {_words(directions, lies=lies, leaning=leaning)}: the thighs are "
            f"turned from the trunk by {bent:.0f} degrees, and the trunk from the vertical by "
            f"{leaning:.0f}."
        ),
        remedy="Have the person stand upright, with straight legs.",
        points=("left_hip", "right_hip", "left_knee", "right_knee"),
    )


def detected_directions(capture: Capture) -> Directions:
    """By the detector's points and slants; a trunk is taken to be parallel to the picture."""
    shoulders, hips = capture.middle("shoulder"), capture.middle("hip")
    found: dict[str, Float[np.ndarray, 3]] = {}
    if shoulders is not None and hips is not None and (shoulders != hips).any():
        found["trunk"] = _direction(shoulders - hips, 0.0)
    slants = {} if capture.body is None else capture.body.slants.limbs
    for name, slant in slants.items():
        side, _, limb = name.partition("_")
        ends = {"thigh": ("hip", "knee"), "shin": ("knee", "ankle")}.get(limb)
        if ends is None or any(f"{side}_{end}" not in capture.joints for end in ends):
            continue
        near, far = (capture.joints[f"{side}_{end}"] for end in ends)
        sine = slant.sine
        if limb == "thigh" and shoulders is not None and hips is not None:
            least = LEAST_THIGH * float(np.linalg.norm(shoulders - hips))
            share = float(np.linalg.norm(far - near)) / max(least, 1e-9)
            sine = float(np.copysign(max(abs(sine), np.sqrt(max(1.0 - share**2, 0.0))), sine))
        found[name] = _direction(far - near, sine)
    return found


def angle_deg(one: Float[np.ndarray, "3"], other: Float[np.ndarray, "3"]) -> float:
    """Between two unit vectors."""
    return float(np.degrees(np.arccos(np.clip(one @ other, -1.0, 1.0))))


def _direction(in_picture: Float[np.ndarray, "2"], sine: float) -> Float[np.ndarray, "3"]:
    across = np.sqrt(max(1.0 - sine**2, 0.0)) / max(float(np.linalg.norm(in_picture)), 1e-9)
    return np.array([across * in_picture[0], across * in_picture[1], sine])


def _words(directions: Directions, *, lies: bool, leaning: float) -> str:
    if lies:
        return "lies"
    knees = [
        angle_deg(directions[f"{side}_thigh"], directions[f"{side}_shin"])
        for side in ("left", "right")
        if f"{side}_shin" in directions
    ]
    if knees and min(knees) > _KNEES_DEG:
        return "sits or crouches"
    return "bends over" if leaning > BENT_DEG else "sits or bends the hips"
