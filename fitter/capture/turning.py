"""From where the person is seen, and whether that is what was said.

A trunk's shoulders and hips are as broad in the picture as the cosine of how far it is turned;
left and right are the person's own, so that the breadth of a trunk seen from behind is negative.
Faces do not tell: the detector calls eyes visible from behind too.
"""

import math

import numpy as np

from fitter.capture.capture import Capture
from fitter.capture.finding import Code, Finding, Remark, Unchecked
from fitter.vocabulary.choices import ViewKind
from fitter.vocabulary.outcomes import SeenFrom, Severity

FRONTAL_BREADTHS = {"shoulder": 0.83, "hip": 0.46}
"""Breadth of the detector's joints facing the camera, of the trunk's length."""

LEAST_FRONTAL = 0.65
"""Cosine from which a person faces the camera or turns their back to it: within 50 degrees."""

MOST_LATERAL = 0.4
"""Cosine up to which a person is seen from the side: within 24 degrees of profile."""

_SAID = {
    ViewKind.FRONT: "from the front",
    ViewKind.SIDE: "from the side",
    ViewKind.BACK: "from behind",
}
_TURN_DEG = {ViewKind.FRONT: 0, ViewKind.SIDE: 90, ViewKind.BACK: 180}


def facing(capture: Capture) -> float | None:
    """Cosine of how far the trunk is turned from the camera, in [-1, 1].

    1 faces the camera, 0 is seen from the side, -1 from behind; None if a shoulder or a hip is
    missing.
    """
    shoulders, hips = capture.middle("shoulder"), capture.middle("hip")
    if shoulders is None or hips is None:
        return None
    length = float(np.linalg.norm(hips - shoulders))
    if length == 0.0:
        return None
    down_x, down_y = (hips - shoulders) / length
    cosines: list[float] = []
    for pair, breadth in FRONTAL_BREADTHS.items():
        across = capture.joints[f"left_{pair}"] - capture.joints[f"right_{pair}"]
        cosines.append(float(across @ np.array([down_y, -down_x])) / length / breadth)
    return max(-1.0, min(1.0, sum(cosines) / len(cosines)))


def seen_from(cosine: float) -> SeenFrom:
    """The view of a person who is turned by the arc of that cosine."""
    if abs(cosine) <= MOST_LATERAL:
        return SeenFrom.SIDE
    if abs(cosine) < LEAST_FRONTAL:
        return SeenFrom.BETWEEN
    return SeenFrom.FRONT if cosine > 0.0 else SeenFrom.BACK


def is_broadside(capture: Capture) -> bool:
    """Whether the person is seen from the front or from behind."""
    cosine = facing(capture)
    return cosine is not None and abs(cosine) >= LEAST_FRONTAL


def announced_view(capture: Capture) -> Remark | None:
    """Whether the person is seen from where they are said to be."""
    if capture.view is None or capture.view is ViewKind.OTHER:
        return None
    cosine = facing(capture)
    if cosine is None:
        return Unchecked(
            code=Code.OTHER_VIEW, reason="Shoulders and hips are not all in the picture."
        )
    seen = seen_from(cosine)
    if seen.value == capture.view.value:
        return None
    return Finding(
        code=Code.OTHER_VIEW,
        severity=Severity.HARMS if seen is SeenFrom.BETWEEN else Severity.BLOCKS,
        reason=(
            f"The person is to be seen {_SAID[capture.view]} and is turned from the camera by "
            f"about {math.degrees(math.acos(cosine)):.0f} degrees, where "
            f"{_TURN_DEG[capture.view]} are meant."
        ),
        remedy=f"Have the person turn until the camera sees them {_SAID[capture.view]}.",
        points=("left_shoulder", "right_shoulder", "left_hip", "right_hip"),
    )
