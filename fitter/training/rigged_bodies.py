"""Subjects of the population as registered bodies that the rig can pose."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy import sparse

from fitter.arrays import Pose, Vertices
from fitter.training.assemble import RegisteredBodies
from fitter.training.joints import joint_rows_of_bones
from fitter.training.makehuman import BaseMesh
from fitter.training.rig import Rig, bone_heads, part_weights, posed_vertices


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
    """

    surface: BaseMesh
    rig: Rig
    skin: sparse.csr_array
    part_weights: Float[np.ndarray, "m p"]


def rigged_mesh(surface: BaseMesh, rig: Rig) -> RiggedMesh:
    """Join mesh and rig."""
    skin = sparse.csr_array(rig.weights[surface.body_vertex_ids])
    return RiggedMesh(surface=surface, rig=rig, skin=skin, part_weights=part_weights(rig, skin))


def rigged_bodies(mesh: RiggedMesh, sources: Float[np.ndarray, "s v 3"]) -> RegisteredBodies:
    """Bodies at rest, their joints, and their answer to any pose.

    Parameters
    ----------
    mesh
        From :func:`rigged_mesh`.
    sources
        All source vertices of each subject at rest, body frame, metres.
    """
    rest = mesh.surface.body(sources).astype(np.float64)
    heads = np.stack([bone_heads(mesh.rig, source.astype(np.float64)) for source in sources])

    def posed(subject: int, pose: Pose) -> Vertices:
        return posed_vertices(mesh.rig, mesh.skin, rest[subject], heads[subject], pose)

    return RegisteredBodies(
        rest=rest,
        joints=np.einsum("pb,sbc->spc", joint_rows_of_bones(mesh.rig.bone_names), heads),
        posed=posed,
    )
