"""Bodies on one mesh, at rest and in any pose: subjects of the population, posed by the rig.

MakeHuman's hands rest flat with the fingers spread. The body model has no joints within the hand,
so whatever hand it is trained with it keeps, and people's hands hang half closed. So hands are
relaxed: the rig's fingers slightly bent and brought together, the thumb beside them.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy import sparse

from fitter.arrays import Pose, Rotations, Vertices
from fitter.numerics.rotations import rotation_matrices
from fitter.training.articulation.joints import joint_rows_of_bones
from fitter.training.articulation.rig import (
    Rig,
    blend_linear,
    bone_heads,
    part_weights,
    placed_heads,
    posed_vertices,
)
from fitter.training.articulation.volume import (
    JointSurroundings,
    joint_surroundings,
    with_volume_kept,
)
from fitter.training.makehuman.meshes import BaseMesh

FINGERS = (2, 3, 4, 5)
JOINT_SHARES = (0.9, 1.2, 0.8)
"""Shares of the bend in a finger's three joints, knuckle first."""

SPREAD_TAKEN = 0.8
"""Share of the fan that the fingers form at rest by which they are brought together."""

THUMB_DEGREES = 18.0
"""Angle by which the thumb is brought to the fingers."""

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


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RegisteredBodies:
    """Bodies on one mesh, at rest in one pose, body frame, metres.

    Attributes
    ----------
    rest
        (s, m, 3).
    joints
        (s, p, 3) true centres about which the parts turn.
    posed
        Body of an index in a pose: a rig's answer here, registered scans for those who have them.
    measurements
        (s, k) in any units, that the shape space shall keep beside the vertices; None to keep
        vertices alone.
    """

    rest: Float[np.ndarray, "s m 3"]
    joints: Float[np.ndarray, "s p 3"]
    posed: Callable[[int, Pose], Vertices]
    measurements: Float[np.ndarray, "s k"] | None = None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RiggedMesh:
    """The body mesh with the rig that moves it.

    Attributes
    ----------
    surface
        The closed body within the base mesh.
    rig
        The default rig.
    skin
        (m, b) sparse skinning weights of the body's vertices.
    part_weights
        (m, p) the same summed over each part.
    surroundings
        What each joint deforms.
    """

    surface: BaseMesh
    rig: Rig
    skin: sparse.csr_array
    part_weights: Float[np.ndarray, "m p"]
    surroundings: tuple[JointSurroundings, ...]


def rigged_mesh(surface: BaseMesh, rig: Rig) -> RiggedMesh:
    """Join mesh and rig."""
    skin = sparse.csr_array(rig.weights[surface.body_vertex_ids])
    return RiggedMesh(
        surface=surface,
        rig=rig,
        skin=skin,
        part_weights=part_weights(rig, skin),
        surroundings=joint_surroundings(rig, skin, surface.triangles),
    )


def rigged_bodies(
    mesh: RiggedMesh,
    sources: Float[np.ndarray, "s v 3"],
    measurements: Float[np.ndarray, "s k"] | None = None,
) -> RegisteredBodies:
    """Bodies at rest with relaxed hands, their joints, and their answer to any pose.

    Parameters
    ----------
    mesh
        From :func:`rigged_mesh`.
    sources
        All source vertices of each subject at rest, body frame, metres.
    measurements
        As in :class:`~fitter.training.assemble.RegisteredBodies`.
    """
    rig, skin, triangles = mesh.rig, mesh.skin, mesh.surface.triangles
    heads = np.stack([bone_heads(rig, source.astype(np.float64)) for source in sources])
    joints = np.einsum("pb,sbc->spc", joint_rows_of_bones(rig.bone_names), heads)
    flat = mesh.surface.body(sources).astype(np.float64)
    rest = np.stack(
        [
            with_curled_fingers(rig, skin, body, centres, RELAXED)
            for body, centres in zip(flat, heads, strict=True)
        ]
    )

    def posed(subject: int, pose: Pose) -> Vertices:
        body, centres = rest[subject], heads[subject]
        return with_volume_kept(
            rig,
            mesh.surroundings,
            triangles,
            rest=body,
            heads=centres,
            joints=joints[subject],
            pose=pose,
            posed=posed_vertices(rig, skin, body, centres, pose),
        )

    return RegisteredBodies(rest=rest, joints=joints, posed=posed, measurements=measurements)
