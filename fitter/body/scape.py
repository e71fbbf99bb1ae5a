"""SCAPE at run time: shape and pose to vertices, and its exact reverse (section 3).

Every triangle t of part p has the target deformation gradient R_p [D_t(β) + E_t(β, θ)], and the
mesh is the least-squares solution, min over Y of Σ_t w_t ‖R_p(t) [D_t + E_t] - grad_t(Y)‖². The
normal equations have one fixed matrix, L = Gᵀ W G, and a right-hand side that is a sum over parts
of R_p times something linear in β and in the pose features (:mod:`fitter.body.scape`), each
with its strength 1 + s . β: L is factored once, and an evaluation is an assembly and two triangular
solves. The derivative of any scalar with respect to all parameters costs one more solve, because L
is symmetric.

A part lists its joints by number. Number j of p stands for the joint's whole turn R_j, number p + j
for half of it, H_j with H_j² = R_j and an angle of less than half a turn: a shoulder blade follows
a raised arm by a share of its angle, which the sine and cosine of the whole angle do not give.
"""

from dataclasses import dataclass

import numpy as np
import qdldl
from jaxtyping import Float, Integer
from scipy import sparse

from fitter.arrays import Pose, Rotations, Shape, Vector3, Vertices
from fitter.body import _scape_kernels as kernels
from fitter.body._scape_kernels import (
    assemble_right_hand_side,
    gather_gradient,
    place,
    place_reverse,
)
from fitter.body.model import BodyModel, SparseRows, descendants, global_rotations
from fitter.numerics.meshes import gradient_operator, part_laplacians
from fitter.numerics.rotations import compose, rotation_matrices
from fitter.numerics.sparse_factor import SparseFactor, sparse_factor
from fitter.parameters import BodyParameters

FeatureJoints = Integer[np.ndarray, "p q"]


def half_turns(pose: Pose) -> Pose:
    """Rotation vectors of half the turns, each taken the short way around."""
    halves = np.empty_like(pose)
    kernels.half_vectors(pose, halves)
    return halves


def pose_features(pose: Pose, joints: FeatureJoints) -> Float[np.ndarray, "p nine_q"]:
    """(R - I) of each part's joints, joint by joint and row by row, zero where unused (-1)."""
    features = np.empty((len(joints), 9 * joints.shape[1]))
    kernels.turns_less_identity(_turns(pose), joints, features)
    return features


def pose_derivative(
    pose: Pose, joints: FeatureJoints, feature_derivative: Float[np.ndarray, "p nine_q"]
) -> Pose:
    """Derivative of a scalar by increments δ of each joint, applied as exp(δ) exp(pose).

    From (exp(η) H)² = exp(δ) H² follows (I + H) η = δ for half turns.

    Parameters
    ----------
    pose, joints
        As in :func:`pose_features`.
    feature_derivative
        Derivative of the scalar by the features.
    """
    count = len(pose)
    turns = _turns(pose)
    torques = np.empty((len(turns), 3))
    kernels.turn_torques(turns, joints, np.ascontiguousarray(feature_derivative), torques)
    result = torques[:count].copy()
    kernels.add_half_turn_torques(turns, torques, result)
    return result


def axial_vectors(matrices: Rotations) -> Float[np.ndarray, "p 3"]:
    """Axial vectors w of matrices A: <A, [v]×> = w · v for every v."""
    return np.stack(
        [
            matrices[:, 2, 1] - matrices[:, 1, 2],
            matrices[:, 0, 2] - matrices[:, 2, 0],
            matrices[:, 1, 0] - matrices[:, 0, 1],
        ],
        axis=1,
    )


def _turns(pose: Pose) -> Float[np.ndarray, "2*p 3 3"]:
    """(2 p, 3, 3) whole turns, then half turns."""
    return rotation_matrices(np.concatenate([pose, half_turns(pose)]))


CAMERA_AXES = np.array([1.0, -1.0, -1.0])
"""Body-frame axes in the camera frame: x stays, y and z turn round."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BodyDerivative:
    """Derivative of a scalar with respect to the body.

    Attributes
    ----------
    pose
        (p, 3) with respect to increments δ applied as exp(δ) exp(pose), radians: local
        coordinates that have no pole.
    translation
        (3,) per metre.
    shape
        (n,) per standard deviation.
    """

    pose: Pose
    translation: Vector3
    shape: Shape


def increment(
    parameters: BodyParameters, *, pose: Pose, translation: Vector3, shape: Shape
) -> BodyParameters:
    """Parameters moved by the local increments that :class:`BodyDerivative` refers to."""
    return BodyParameters(
        pose=compose(pose, parameters.pose),
        translation=parameters.translation + translation,
        shape=parameters.shape + shape,
    )


class ScapeEvaluator:
    """A body model with its factored least squares; safe to share between fits of one thread."""

    def __init__(self, model: BodyModel) -> None:
        self.model = model
        gradient = gradient_operator(model.mean_vertices, model.triangles)
        laplacians = part_laplacians(
            gradient, model.triangle_weights, model.part_of_triangle, len(model.part_names)
        )
        self._terms, self._term_widths = _terms(model, _shape_terms(model, laplacians))
        self._root_weights = _root_weights(model)
        self._moves = descendants(model.part_parent)
        self._factor = _factor(laplacians)

    def vertices(self, parameters: BodyParameters) -> Vertices:
        """Posed vertices, camera frame, metres."""
        return self._placed(parameters, CAMERA_AXES, parameters.translation)

    def body_frame_vertices(self, parameters: BodyParameters) -> Vertices:
        """Posed vertices in the body frame's axes, metres, root joint at the origin."""
        return self._placed(parameters, np.ones(3), np.zeros(3))

    def _placed(self, parameters: BodyParameters, axes: Vector3, translation: Vector3) -> Vertices:
        """Posed vertices with the root joint at ``translation``, along body axes times ``axes``."""
        rotations = global_rotations(parameters.pose, self.model.part_parent)
        features = self._strengths(parameters.shape) * pose_features(
            parameters.pose, self.model.pose_feature_joints
        )
        right_hand_side = np.empty_like(self.model.mean_vertices)
        assemble_right_hand_side(
            self._terms,
            self._term_widths,
            parameters.shape,
            features,
            self.model.incidence_pointers,
            self.model.incidence_vertices,
            rotations,
            right_hand_side,
        )
        placed = np.empty_like(right_hand_side)
        place(self._factor.solve(right_hand_side), self._root_weights, axes, translation, placed)
        return placed

    def derivative(self, parameters: BodyParameters, vertex_derivative: Vertices) -> BodyDerivative:
        """Pull the derivative of a scalar with respect to camera-frame vertices back to the body.

        Parameters
        ----------
        parameters
            Where the scalar was evaluated.
        vertex_derivative
            (m, 3) derivative with respect to :meth:`vertices`.
        """
        unsolved, translation = np.empty_like(vertex_derivative), np.empty(3)
        place_reverse(vertex_derivative, self._root_weights, CAMERA_AXES, unsolved, translation)
        adjoint = self._factor.solve(unsolved)
        rotations = global_rotations(parameters.pose, self.model.part_parent)
        strengths = self._strengths(parameters.shape)
        unscaled = pose_features(parameters.pose, self.model.pose_feature_joints)
        features = strengths * unscaled
        shape = np.empty(len(parameters.shape))
        feature_derivative = np.empty(features.shape)
        rotation_derivative = np.empty_like(rotations)
        gather_gradient(
            self._terms,
            self._term_widths,
            parameters.shape,
            features,
            self.model.incidence_pointers,
            self.model.incidence_vertices,
            rotations,
            adjoint,
            shape,
            feature_derivative,
            rotation_derivative,
        )
        return BodyDerivative(
            pose=self._pose_derivative(
                parameters.pose, rotations, rotation_derivative, strengths * feature_derivative
            ),
            translation=translation,
            shape=shape
            + np.einsum(
                "pa,pan->n", unscaled * feature_derivative, self.model.pose_feature_strengths
            ),
        )

    def _pose_derivative(
        self,
        pose: Pose,
        rotations: Rotations,
        rotation_derivative: Rotations,
        feature_derivative: Float[np.ndarray, "p nine_q"],
    ) -> Pose:
        torques = axial_vectors(np.matmul(rotation_derivative, rotations.transpose(0, 2, 1)))
        gathered = self._moves @ torques
        parents = self.model.part_parent
        parent_rotations = np.where((parents < 0)[:, None, None], np.eye(3), rotations[parents])
        chain = np.einsum("pij,pi->pj", parent_rotations, gathered)
        return chain + pose_derivative(pose, self.model.pose_feature_joints, feature_derivative)

    def _strengths(self, shape: Shape) -> Float[np.ndarray, "p nine_q"]:
        return 1.0 + self.model.pose_feature_strengths @ shape


def _shape_terms(
    model: BodyModel, laplacians: list[sparse.csr_array]
) -> Float[np.ndarray, "i 3 n1"]:
    """L_p [μ, U] at the incidences of each part; formed in double, stored in single precision."""
    n = len(model.shape_basis)
    stacked = np.concatenate([model.mean_vertices[None], model.shape_basis])
    columns = stacked.transpose(1, 2, 0).reshape(len(model.mean_vertices), 3 * (n + 1))
    blocks: list[np.ndarray] = []
    for part, laplacian in enumerate(laplacians):
        start, stop = model.incidence_pointers[part], model.incidence_pointers[part + 1]
        rows = laplacian[model.incidence_vertices[start:stop]]
        blocks.append(rows @ columns)
    terms = np.concatenate(blocks).reshape(-1, 3, n + 1)
    return np.ascontiguousarray(terms, dtype=np.float32)


def _terms(
    model: BodyModel, shape_terms: Float[np.ndarray, "i 3 n1"]
) -> tuple[Float[np.ndarray, " t"], Integer[np.ndarray, " p"]]:
    """Rows of shape terms and used pose terms, part after part; and the rows' widths.

    Most parts have fewer neighbouring joints than the chest. An evaluation reads all rows in one
    pass, because they exceed a processor's own cache.
    """
    used = model.pose_feature_joints >= 0
    features = 9 * np.max(np.where(used, np.arange(used.shape[1]) + 1, 0), axis=1)
    blocks: list[np.ndarray] = []
    for part, width in enumerate(features):
        rows = slice(model.incidence_pointers[part], model.incidence_pointers[part + 1])
        pose_terms = model.pose_right_hand_sides[rows, :, :width]
        blocks.append(np.concatenate([shape_terms[rows], pose_terms], axis=2).ravel())
    return np.concatenate(blocks).astype(np.float32), features + shape_terms.shape[2]


def _root_weights(model: BodyModel) -> Float[np.ndarray, " m"]:
    rows: SparseRows = model.joint_regressor
    weights = np.zeros(len(model.mean_vertices))
    np.add.at(weights, rows.indices[: rows.pointers[1]], rows.weights[: rows.pointers[1]])
    return weights / weights.sum()


def _factor(laplacians: list[sparse.csr_array]) -> SparseFactor:
    """LDLᵀ of the whole Laplacian with vertex 0 held.

    The matrix leaves translation free. A weight on one vertex fixes it without changing the
    solution, because the right-hand sides sum to zero: the held vertex simply lands at the origin.
    """
    matrix = sparse.csc_matrix(sum(laplacians[1:], start=laplacians[0]))
    matrix[0, 0] += matrix.diagonal().mean()
    solver = qdldl.Solver(matrix)
    lower, diagonal, permutation = solver.factors()
    return sparse_factor(sparse.csc_matrix(lower), diagonal, permutation)
