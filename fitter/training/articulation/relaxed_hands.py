"""Relaxed hands: the rig's fingers slightly bent and brought together, the thumb beside them.

MakeHuman's hands rest flat with the fingers spread. The body model has no joints within the hand,
so whatever hand it is trained with it keeps, and people's hands hang half closed.
"""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float
from scipy import sparse

from fitter.arrays import Rotations, Vertices
from fitter.numerics.rotations import rotation_matrices
from fitter.training.articulation.rig import Rig, placed_heads
from fitter.training.articulation.skinning import blend_linear

FINGERS = (2, 3, 4, 5)
JOINT_SHARES = (0.9, 1.2, 0.8)
"""How the bend is shared by a finger's three joints, knuckle first."""

SPREAD_TAKEN = 0.8
"""Share of the fan that the fingers form at rest by which they are brought together."""

THUMB_DEGREES = 18.0
"""How far the thumb is brought to the fingers."""

RELAXED_DEGREES = 16.0
"""Mean bend of a finger joint beyond the rig's rest, which is bent by some ten degrees."""

RELAXED: Mapping[str, float] = {"left": RELAXED_DEGREES, "right": RELAXED_DEGREES}


def with_curled_fingers(
    rig: Rig,
    skin: sparse.csr_array,
    rest: Vertices,
    heads: Float[np.ndarray, "b 3"],
    curl: Mapping[str, float],
) -> Vertices:
    """A body at rest with bent fingers; all other bones stay.

    Parameters
    ----------
    rig
        From :func:`fitter.training.articulation.rig.load_rig`.
    skin
        (m, b) the rows of the rig's weights that belong to the vertices.
    rest
        (m, 3) the body at rest, body frame, metres.
    heads
        (b, 3) its bone centres.
    curl
        Mean bend of the finger joints by side, degrees.
    """
    rotations = finger_rotations(rig.bone_names, heads, curl)
    centres = placed_heads(rig, heads, rotations)
    translations = centres - np.einsum("bij,bj->bi", rotations, heads)
    return blend_linear(skin, rotations, translations, rest)


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
