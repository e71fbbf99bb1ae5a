"""Pose-dependent terms for bodies without scans in poses: taken over from a model, or none."""

import numpy as np
from jaxtyping import Float
from scipy import sparse
from scipy.sparse.linalg import splu

from fitter.body.model import BodyModel
from fitter.numerics.gradient_operators import gradient_operator, part_laplacians
from fitter.training.articulation.parts import Parts
from fitter.training.articulation.pose_term import PoseTerm, pose_feature_joints
from fitter.training.assemble import ShapeSpace
from fitter.training.shapes.principal_shapes import project, vertex_masses

LEAST_STRENGTH = 0.2
"""A feature keeps at least this share of its strength on the new mean body: bodies far from the
packaged population would turn it round."""

_REGULARISATION = 1e-6
"""Relative; holds the translation that a part's Laplacian leaves free."""


def no_pose_term(space: ShapeSpace, parts: Parts) -> PoseTerm:
    """E = 0: parts turn rigidly and the skin between them is stretched."""
    joints = pose_feature_joints()
    return PoseTerm(
        right_hand_sides=np.zeros((len(parts.incidence_vertices), 3, 9 * joints.shape[1])),
        strengths=np.zeros((len(joints), 9 * joints.shape[1], len(space.basis))),
    )


def transferred_pose_term(space: ShapeSpace, packaged: BodyModel) -> PoseTerm:
    """A model's E on another mean body and shape space of the same surface.

    A file keeps L_p x = Gᵀ W E of its own mean. Solved for x, the displacement in the part's frame
    whose gradients come nearest to E, it is multiplied by L_p of the new mean. A strength 1 + s . β
    is linear in the shape: with β = b + B β' of the nearest packaged body it becomes
    (1 + s . b) (1 + s B / (1 + s . b) . β').
    """
    old = part_laplacians(
        gradient_operator(packaged.mean_vertices, packaged.triangles),
        packaged.triangle_weights,
        packaged.part_of_triangle,
        len(packaged.part_names),
    )
    offset, turn = _packaged_coefficients(space, packaged)
    strengths = packaged.pose_feature_strengths
    at_mean = np.maximum(1.0 + strengths @ offset, LEAST_STRENGTH)
    right_hand_sides = np.empty(packaged.pose_right_hand_sides.shape)
    pointers = packaged.incidence_pointers
    for part, (before, after) in enumerate(zip(old, space.laplacians, strict=True)):
        span = slice(pointers[part], pointers[part + 1])
        vertices = packaged.incidence_vertices[span]
        right = packaged.pose_right_hand_sides[span].astype(np.float64) * at_mean[part]
        local = before[vertices][:, vertices]
        held = _REGULARISATION * local.diagonal().mean() * sparse.eye_array(len(vertices))
        displacement = splu(sparse.csc_matrix(local + held)).solve(right.reshape(len(vertices), -1))
        right_hand_sides[span] = (after[vertices][:, vertices] @ displacement).reshape(right.shape)
    return PoseTerm(
        right_hand_sides=right_hand_sides, strengths=(strengths @ turn) / at_mean[..., None]
    )


def _packaged_coefficients(
    space: ShapeSpace, packaged: BodyModel
) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, "n k"]]:
    """Packaged coefficients b nearest to the new mean, and their change B along each new axis."""
    masses = vertex_masses(packaged.mean_vertices, packaged.triangles)
    meshes = np.concatenate([space.mean[None], space.mean + space.basis])
    found, _ = project(meshes, masses, packaged.mean_vertices, packaged.shape_basis)
    return found[0], (found[1:] - found[0]).T
