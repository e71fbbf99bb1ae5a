"""How far a click may lie from the landmark it means, as a length on the body.

A hand on the mouse errs by 2 to 3 pixels where a person fills most of a 640 x 480 picture, about a
centimetre on the body. What people take the point to be adds to that, and differs by landmark: an
eye is where it is, but a hip is clicked anywhere between the joint and the hip's bulge, and a head
top under hair is a guess. Believing all clicks alike turns the trunk by tens of degrees to explain
hips clicked a little wide or narrow.
"""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from fitter.pose_init.points import ClickedPoints

DEFAULT_SPREAD_M = 0.015
SPREADS_M: Mapping[str, float] = {
    "left_hip": 0.025,
    "right_hip": 0.025,
    "left_shoulder": 0.02,
    "right_shoulder": 0.02,
    "neck": 0.03,
    "head_top": 0.03,
    "left_toe": 0.02,
    "right_toe": 0.02,
}
"""Standard deviations in each direction of the picture, metres; others have the default."""

OCCLUDED_FACTOR = 3.0
"""How much less a hidden point's click is believed."""


def click_spreads_m(clicks: ClickedPoints) -> Float[np.ndarray, " k"]:
    """Standard deviations of clicks, metres on the body; proposed points have their own."""
    return np.array(
        [
            SPREADS_M.get(name, DEFAULT_SPREAD_M) * (OCCLUDED_FACTOR if occluded else 1.0)
            if spread is None
            else spread
            for name, occluded, spread in zip(
                clicks.names, clicks.occluded, clicks.spread_m, strict=True
            )
        ]
    )
