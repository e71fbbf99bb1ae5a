"""Relaxed hands: the rig's finger bones bent, which the body model's rigid hands do not know."""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from fitter.arrays import Rotations
from fitter.numerics.rotations import rotation_matrices

FINGERS = (2, 3, 4, 5)
JOINT_SHARES = (0.9, 1.2, 0.8)
"""How the bend is shared by a finger's three joints, knuckle first."""

SPREAD_TAKEN = 0.8
"""Share of the fan that the fingers form at rest by which they are brought together."""

THUMB_DEGREES = 18.0
"""How far the thumb is brought to the fingers."""


def finger_rotations(
    bone_names: tuple[str, ...], heads: Float[np.ndarray, "b 3"], curl: Mapping[str, float]
) -> Rotations:
    """Rotation of every bone, body frame at rest; the identity but for fingers."""
    index = {name: k for k, name in enumerate(bone_names)}
    rotations = np.broadcast_to(np.eye(3), (len(heads), 3, 3)).copy()
    for side, degrees in curl.items():
        suffix = side[0].upper()
        where = {
            (finger, joint): index[f"finger{finger}-{joint}.{suffix}"]
            for finger in (1, *FINGERS)
            for joint in (1, 2, 3)
        }
        across = heads[where[2, 1]] - heads[where[5, 1]]
        along = heads[where[3, 2]] - heads[where[3, 1]]
        along /= np.linalg.norm(along)
        # From the little finger's knuckle to the index finger's: about it, fingers bend into the
        # palm by a turn that is negative on the left hand and positive on the right.
        hinge = across - (across @ along) * along
        hinge /= np.linalg.norm(hinge)
        sign = -1.0 if side == "left" else 1.0
        palm = np.cross(along, hinge)
        for finger in FINGERS:
            own = heads[where[finger, 2]] - heads[where[finger, 1]]
            fan = np.arctan2(own @ hinge, own @ along)
            turn = _about(palm, -SPREAD_TAKEN * fan)
            for joint, share in zip((1, 2, 3), JOINT_SHARES, strict=True):
                turn = _about(hinge, sign * np.radians(degrees * share)) @ turn
                rotations[where[finger, joint]] = turn
        thumb = heads[where[1, 2]] - heads[where[1, 1]]
        inward = np.cross(thumb, along)
        for joint in (1, 2, 3):
            rotations[where[1, joint]] = _about(
                inward / np.linalg.norm(inward), np.radians(THUMB_DEGREES)
            )
    return rotations


def _about(axis: Float[np.ndarray, "3"], angle: float) -> Float[np.ndarray, "3 3"]:
    return rotation_matrices((angle * axis)[None])[0]
