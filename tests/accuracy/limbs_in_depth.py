"""Whether limbs face the right way: toward the camera or away from it (section 3.1)."""

import numpy as np
from jaxtyping import Float

from fitter.training.articulation.parts import part_index

WRONG_BY = 0.35
"""Difference of two slants, as a share of the limb's length, that turns a limb the wrong way if
they differ in sign: about 20 degrees, more than any unsteady click makes."""

_ENDS = (("upper_arm", "forearm"), ("forearm", "hand"), ("thigh", "shin"), ("shin", "foot"))

Joints = Float[np.ndarray, "p 3"]


def wrong_limbs(found: Joints, true: Joints) -> tuple[str, ...]:
    """Names of the limbs that slant the wrong way; joints in the camera frame."""
    return tuple(
        f"{side}_{near}"
        for side in ("left", "right")
        for near, far in _ENDS
        if _wrong(_slant(found, side, near, far), _slant(true, side, near, far))
    )


def _wrong(found: float, true: float) -> bool:
    return found * true < 0.0 and abs(found - true) > WRONG_BY


def _slant(joints: Joints, side: str, near: str, far: str) -> float:
    limb = joints[part_index(f"{side}_{far}")] - joints[part_index(f"{side}_{near}")]
    return float(limb[2] / np.linalg.norm(limb))
