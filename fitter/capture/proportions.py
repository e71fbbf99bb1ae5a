"""Whether the proportions are a child's: the body models know grown-up people alone."""

from typing import Final

import numpy as np

from fitter.capture.capture import Capture
from fitter.capture.finding import Code, Finding, Remark, Unchecked
from fitter.capture.posture import posture
from fitter.vocabulary.outcomes import Severity

MOST_BETWEEN_EYES: Final = 0.055
"""Distance of the detector's eyes, as a share of the stature. It is 0.048 at most in 110 pictures
of grown-up people and 0.037 on average from the front (tuning half); children's eyes are a sixth
farther apart at ten years, a quarter at five and two thirds at one, by their stature. So small
children are found. The ears' distance would find more, and is too near to that of some adults."""


def proportions(capture: Capture) -> Remark | None:
    """Whether the eyes are too far apart for the stature of a grown-up person.

    Clicks are not looked at: they lie farther apart than the detector's eyes.
    """
    if capture.body is None:
        return Unchecked(code=Code.CHILD, reason="Without a detector eyes are not compared.")
    eyes = [capture.joints.get(f"{side}_eye") for side in ("left", "right")]
    if eyes[0] is None or eyes[1] is None or capture.stature_px is None:
        return Unchecked(code=Code.CHILD, reason="Both eyes are not seen.")
    # How tall somebody is who does not stand, a picture hardly tells.
    if posture(capture) is not None:
        return Unchecked(code=Code.CHILD, reason="The person is not seen to stand.")
    share = float(np.linalg.norm(eyes[0] - eyes[1])) / capture.stature_px
    if share <= MOST_BETWEEN_EYES:
        return None
    return Finding(
        code=Code.CHILD,
        severity=Severity.BLOCKS,
        reason=(
            f"The eyes are {100.0 * share:.1f} % of the stature apart, and those of grown-up "
            f"people at most {100.0 * MOST_BETWEEN_EYES:.1f}: this seems to be a child, and the "
            "bodies are those of grown-up people."
        ),
        remedy="Measure grown-up people alone; if this is one, let the face be seen clearly.",
        points=("left_eye", "right_eye"),
    )
