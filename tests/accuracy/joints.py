"""Joints found beside true ones, camera frame: distances, and limbs that slant the wrong way."""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from fitter.training.articulation.parts import part_index

MOVED_PARTS: Mapping[str, str] = {
    "shoulder": "upper_arm", "elbow": "forearm", "wrist": "hand", "hip": "thigh", "knee": "shin",
    "ankle": "foot",
}  # fmt: skip
"""The part that turns about each joint."""

Joints = Float[np.ndarray, "p 3"]
"""Camera frame, metres; NaN where the truth has none."""

WRONG_BY = 0.35
"""Difference of two slants, as a share of the limb's length, that turns a limb the wrong way if
they differ in sign: about 20 degrees, more than any unsteady click makes."""

_ENDS = (("upper_arm", "forearm"), ("forearm", "hand"), ("thigh", "shin"), ("shin", "foot"))

_ROOT = 0
_MILLIMETRES = 1000.0


def part_of_joint(joint: str) -> int:
    """The part that turns about a joint of a side, ``left_knee``."""
    side, name = joint.split("_")
    return part_index(f"{side}_{MOVED_PARTS[name]}")


def joint_error_mm(found: Joints, true: Joints) -> float:
    """Mean distance of the joints that the truth has.

    Both root joints are put together; where the truth has none, both hips' middles.
    """
    middle = _hips_middle if np.isnan(true[_ROOT]).any() else _root
    difference = (found - middle(found)) - (true - middle(true))
    return _MILLIMETRES * float(np.nanmean(np.linalg.norm(difference, axis=1)))


def _root(joints: Joints) -> Float[np.ndarray, "3"]:
    return joints[_ROOT]


def _hips_middle(joints: Joints) -> Float[np.ndarray, "3"]:
    return joints[[part_of_joint("left_hip"), part_of_joint("right_hip")]].mean(axis=0)


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
