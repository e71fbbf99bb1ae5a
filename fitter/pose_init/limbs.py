"""Limbs: straight segments whose slant follows from their image length and true length.

Section 3.1: limb lengths are not asked for but predicted, as linear combinations of vertices of
the mean person of the given gender and height. A limb here runs between two clickable landmarks.
The trunk is one limb from the middle of the hips to the middle of the shoulders, with two
cross-pieces, the hip line and the shoulder line, whose slant is its rotation about the long axis.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.pose_init.landmark_rig import LandmarkRig


@dataclass(frozen=True, slots=True, kw_only=True)
class Limb:
    """A limb from its proximal to its distal point, moved by ``part``.

    ``parent`` is the limb it is attached to, None for limbs at the trunk.
    """

    name: str
    proximal: str
    distal: str
    parent: str | None


TORSO = "torso"
PELVIS_MIDDLE = "pelvis_middle"
THORAX_MIDDLE = "thorax_middle"
HIPS = ("right_hip", "left_hip")
SHOULDERS = ("right_shoulder", "left_shoulder")
MIDDLES: Mapping[str, tuple[str, str]] = {PELVIS_MIDDLE: HIPS, THORAX_MIDDLE: SHOULDERS}

LIMBS: tuple[Limb, ...] = (
    Limb(name=TORSO, proximal=PELVIS_MIDDLE, distal=THORAX_MIDDLE, parent=None),
    *(
        limb
        for side in ("left", "right")
        for limb in (
            Limb(
                name=f"{side}_upper_arm",
                proximal=f"{side}_shoulder",
                distal=f"{side}_elbow",
                parent=None,
            ),
            Limb(
                name=f"{side}_forearm",
                proximal=f"{side}_elbow",
                distal=f"{side}_wrist",
                parent=f"{side}_upper_arm",
            ),
            Limb(
                name=f"{side}_thigh",
                proximal=f"{side}_hip",
                distal=f"{side}_knee",
                parent=None,
            ),
            Limb(
                name=f"{side}_shin",
                proximal=f"{side}_knee",
                distal=f"{side}_ankle",
                parent=f"{side}_thigh",
            ),
        )
    ),
)
LIMB_NAMES = tuple(limb.name for limb in LIMBS)
CHAINS = (
    ("left_upper_arm", "left_forearm"),
    ("right_upper_arm", "right_forearm"),
    ("left_thigh", "left_shin"),
    ("right_thigh", "right_shin"),
)
"""The four two-limb chains attached to the trunk."""


def limb_named(name: str) -> Limb:
    """The limb of this name."""
    return LIMBS[LIMB_NAMES.index(name)]


def point_at_rest(rig: LandmarkRig, name: str) -> Float[np.ndarray, "3"]:
    """A limb's end at rest: a landmark, or the middle of two."""
    return end_row(name, rig.landmark_names) @ rig.rest_landmarks


def limb_direction_at_rest(rig: LandmarkRig, limb: Limb) -> Float[np.ndarray, "3"]:
    """From the proximal to the distal point, body frame, metres."""
    return point_at_rest(rig, limb.distal) - point_at_rest(rig, limb.proximal)


def limb_lengths_m(rig: LandmarkRig) -> dict[str, float]:
    """Length of every limb, and of ``hips`` and ``shoulders`` across, metres."""
    lengths = {
        limb.name: float(np.linalg.norm(limb_direction_at_rest(rig, limb))) for limb in LIMBS
    }
    for name, (right, left) in (("hips", HIPS), ("shoulders", SHOULDERS)):
        lengths[name] = float(np.linalg.norm(rig.landmark(left) - rig.landmark(right)))
    return lengths


def end_row(point: str, names: tuple[str, ...]) -> Float[np.ndarray, " k"]:
    """A limb's end as a combination of landmarks in this order."""
    corners = landmarks_of(point)
    return np.array([1.0 / len(corners) if name in corners else 0.0 for name in names])


def limb_slant(limb: Limb, names: tuple[str, ...]) -> Float[np.ndarray, " k"]:
    """Far end minus near end as a combination of landmarks in this order."""
    return end_row(limb.distal, names) - end_row(limb.proximal, names)


def landmarks_of(point: str) -> tuple[str, ...]:
    """The landmarks a limb's end is made of."""
    return MIDDLES.get(point, (point,))
