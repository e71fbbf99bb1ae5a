"""Drives of the rig's bones: the part whose turn moves each, and by what share.

Shares along a chain spread one joint of ours over several bones, as the body spreads it over
several bones and over skin: two vertebrae of the rig for the spine and for the chest each, the
collar bone and shoulder blade that go along with an arm, the forearm in which the wrist's twist
happens between the elbow and the wrist.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Pose
from fitter.numerics.rotations import rotation_matrices
from fitter.training.articulation.parts import part_index, side_and_limb


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BoneDrives:
    """Per bone: its part with its shares of swing and twist, and the same of the part beyond.

    ``axis`` and ``beyond_axis`` are unit vectors, body frame at rest, about which twist is meant.
    ``raised_swing`` comes on top of ``beyond_swing`` where the part beyond is an arm raised high.
    """

    part: Integer[np.ndarray, " b"]
    axis: Float[np.ndarray, "b 3"]
    swing: Float[np.ndarray, " b"]
    twist: Float[np.ndarray, " b"]
    beyond: Integer[np.ndarray, " b"]
    beyond_axis: Float[np.ndarray, "b 3"]
    beyond_swing: Float[np.ndarray, " b"]
    beyond_twist: Float[np.ndarray, " b"]
    raised_swing: Float[np.ndarray, " b"]


# Directions of the bones of the MakeHuman base mesh at rest, left side; right is mirrored in x.
_AXES = {
    "pelvis": (0.0, 1.0, 0.0),
    "spine": (0.0, 1.0, 0.0),
    "chest": (0.0, 1.0, 0.0),
    "neck": (0.0, 0.97, 0.24),
    "head": (0.0, 1.0, 0.0),
    "upper_arm": (0.636, -0.771, 0.0),
    "forearm": (0.521, -0.459, 0.720),
    "hand": (0.521, -0.459, 0.720),
    "thigh": (0.114, -0.993, 0.0),
    "shin": (0.162, -0.983, -0.086),
    "foot": (0.162, -0.983, -0.086),
}

# Bone (without side) -> part, swing share, twist share, part beyond, its swing and twist share.
_OWN = {
    "root": ("pelvis", 1.0, 1.0, "", 0.0, 0.0),
    "pelvis": ("pelvis", 1.0, 1.0, "thigh", 0.1, 0.0),
    "spine05": ("pelvis", 1.0, 1.0, "spine", 1 / 3, 1 / 3),
    "spine04": ("spine", 2 / 3, 2 / 3, "", 0.0, 0.0),
    "spine03": ("spine", 1.0, 1.0, "chest", 1 / 3, 1 / 3),
    "spine02": ("chest", 2 / 3, 2 / 3, "", 0.0, 0.0),
    "spine01": ("chest", 1.0, 1.0, "", 0.0, 0.0),
    "clavicle": ("chest", 1.0, 1.0, "upper_arm", 0.15, 0.0),
    "shoulder01": ("chest", 1.0, 1.0, "upper_arm", 0.35, 0.0),
    "upperarm01": ("upper_arm", 1.0, 0.4, "", 0.0, 0.0),
    "upperarm02": ("upper_arm", 1.0, 1.0, "", 0.0, 0.0),
    "lowerarm01": ("forearm", 1.0, 1.0, "hand", 0.0, 0.25),
    "lowerarm02": ("forearm", 1.0, 1.0, "hand", 0.0, 0.7),
    "neck01": ("neck", 0.5, 0.4, "", 0.0, 0.0),
    "neck02": ("neck", 1.0, 0.8, "", 0.0, 0.0),
    "neck03": ("neck", 1.0, 1.0, "head", 1 / 3, 1 / 3),
    "upperleg01": ("thigh", 1.0, 0.4, "", 0.0, 0.0),
    "upperleg02": ("thigh", 1.0, 1.0, "", 0.0, 0.0),
    "lowerleg01": ("shin", 1.0, 1.0, "", 0.0, 0.0),
    "lowerleg02": ("shin", 1.0, 1.0, "foot", 0.0, 0.4),
}

# Families of bones that follow a part as one piece.
_RIGID = {
    "breast": "chest",
    "wrist": "hand",
    "metacarpal": "hand",
    "finger": "hand",
    "foot": "foot",
    "toe": "foot",
}

_MIDDLE = ("pelvis", "spine", "chest", "neck", "head")


def bone_drives(bone_names: tuple[str, ...]) -> BoneDrives:
    """Drives of the bones of the default rig, by name; bones of the face follow the head."""
    part, axis, swing, twist = [], [], [], []
    beyond, beyond_axis, beyond_swing, beyond_twist = [], [], [], []
    for name in bone_names:
        stem, _, side = name.partition(".")
        own, own_swing, own_twist, next_part, next_swing, next_twist = _drive(stem)
        next_part = next_part or own
        part.append(_sided(own, side))
        axis.append(_axis(own, side))
        swing.append(own_swing)
        twist.append(own_twist)
        beyond.append(_sided(next_part, side))
        beyond_axis.append(_axis(next_part, side))
        beyond_swing.append(next_swing)
        beyond_twist.append(next_twist)
    return BoneDrives(
        part=np.array(part),
        axis=np.array(axis),
        swing=np.array(swing),
        twist=np.array(twist),
        beyond=np.array(beyond),
        beyond_axis=np.array(beyond_axis),
        beyond_swing=np.array(beyond_swing),
        beyond_twist=np.array(beyond_twist),
        raised_swing=np.zeros(len(bone_names)),
    )


def rest_axis(part: str) -> Float[np.ndarray, "3"]:
    """Unit direction of a part's bone at rest, body frame, away from the trunk."""
    side, limb = side_and_limb(part)
    return _axis(limb, side[:1].upper())


def _drive(stem: str) -> tuple[str, float, float, str, float, float]:
    if stem in _OWN:
        return _OWN[stem]
    for family, part in _RIGID.items():
        if stem.startswith(family):
            return (part, 1.0, 1.0, "", 0.0, 0.0)
    return ("head", 1.0, 1.0, "", 0.0, 0.0)


def _sided(part: str, side: str) -> int:
    if part in _MIDDLE:
        return part_index(part)
    return part_index(("left_" if side == "L" else "right_") + part)


def _axis(part: str, side: str) -> Float[np.ndarray, "3"]:
    axis = np.array(_AXES[part])
    if side == "R":
        axis[0] = -axis[0]
    return axis / np.linalg.norm(axis)


FROM_DEGREES, TO_DEGREES = 60.0, 160.0
"""Elevation, from straight down, over which the additional share grows from none to all of it."""


def raised_shares(turns: Pose, axes: Float[np.ndarray, "k 3"]) -> Float[np.ndarray, " k"]:
    """Raising of the arms: 0 below :data:`FROM_DEGREES`, 1 above :data:`TO_DEGREES`.

    Parameters
    ----------
    turns
        (k, 3) rotation vectors from rest, in axes whose y is the trunk's up.
    axes
        Unit directions of the arms at rest.
    """
    directions = np.einsum("kij,kj->ki", rotation_matrices(turns), axes)
    elevations = np.degrees(np.arccos(np.clip(-directions[:, 1], -1.0, 1.0)))
    return smooth_step((elevations - FROM_DEGREES) / (TO_DEGREES - FROM_DEGREES))


def smooth_step(way: np.ndarray) -> np.ndarray:
    """0 before 0, 1 after 1, and in between 3 t² - 2 t³."""
    t = np.clip(way, 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)
