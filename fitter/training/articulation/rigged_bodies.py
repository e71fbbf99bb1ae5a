"""Bodies on one mesh, at rest and in any pose: subjects of the population, posed by the rig."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy import sparse

from fitter.arrays import Pose, Vertices
from fitter.training.articulation.joints import joint_rows_of_bones
from fitter.training.articulation.relaxed_hands import RELAXED, with_curled_fingers
from fitter.training.articulation.rig import Rig, bone_heads, part_weights, posed_vertices
from fitter.training.articulation.volume_keeping import (
    JointSurroundings,
    joint_surroundings,
    with_volume_kept,
)
from fitter.training.makehuman.meshes import BaseMesh


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
