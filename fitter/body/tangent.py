"""A linear-blend tangent of the body: closed-form Jacobians for the Gauss-Newton matrix.

The exact Jacobian of SCAPE has 3 p + 3 + n columns of m vertices and would cost a solve each.
The optimiser needs it only to shape its steps; gradients come exact from
:meth:`fitter.body.scape.ScapeEvaluator.derivative`, and steps are accepted on the true energy.
So the columns are those of linear blend skinning about the posed joints, at chosen points only:
vertices, or weighted sums of vertices such as landmarks.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import Rotations
from fitter.body.model import (
    BodyModel,
    SparseRows,
    dense_rows,
    descendants,
    global_rotations,
    posed_joints,
)
from fitter.body.shape_space import rest_combinations
from fitter.parameters import BodyParameters


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Attachments:
    """Attachment of k points to the body; in single precision, to halve what a search reads.

    Attributes
    ----------
    part_weights
        (k, p) skinning weights, rows sum to one.
    joint_follow
        (k, p) how far the point follows a turn of each joint: weights summed over descendants.
    shape_basis
        (k, n, 3) rest displacement by each shape coefficient.
    """

    part_weights: Float[np.ndarray, "k p"]
    joint_follow: Float[np.ndarray, "k p"]
    shape_basis: Float[np.ndarray, "k n 3"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TangentModel:
    """Arrays of a model for its tangent, independent of shape and pose.

    Attributes
    ----------
    model
        The body model.
    vertices
        Attachments of all m vertices.
    joints_mean, joints_derivative
        Rest joints as an affine function of the shape, (p, 3) and (n, p, 3).
    """

    model: BodyModel
    vertices: Attachments
    joints_mean: Float[np.ndarray, "p 3"]
    joints_derivative: Float[np.ndarray, "n p 3"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Linearisation:
    """The articulated frame at one set of parameters.

    Attributes
    ----------
    translation
        (3,) camera frame, metres.
    rotations
        (p, 3, 3) of every part, body frame.
    parent_rotations
        (p, 3, 3) of every part's parent: the axes in which pose increments turn.
    joints
        (p, 3) posed joints, body frame, root at the origin.
    joint_offsets
        (n, p, 3) motion of each part's frame by each shape coefficient.
    """

    translation: Float[np.ndarray, "3"]
    rotations: Rotations
    parent_rotations: Rotations
    joints: Float[np.ndarray, "p 3"]
    joint_offsets: Float[np.ndarray, "n p 3"]


def tangent_model(model: BodyModel) -> TangentModel:
    """Prepare a model's tangent."""
    m, p = len(model.mean_vertices), len(model.part_names)
    weights = np.zeros((m, p))
    np.add.at(weights, (np.arange(m)[:, None], model.skinning_parts), model.skinning_weights)
    weights /= weights.sum(axis=1, keepdims=True)
    mean, derivative = rest_combinations(model, dense_rows(model.joint_regressor, m))
    return TangentModel(
        model=model,
        vertices=Attachments(
            part_weights=weights.astype(np.float32),
            joint_follow=(weights @ descendants(model.part_parent).T).astype(np.float32),
            shape_basis=model.shape_basis.transpose(1, 0, 2).astype(np.float32, order="C"),
        ),
        joints_mean=mean,
        joints_derivative=np.ascontiguousarray(derivative),
    )


def attached_rows(tangent: TangentModel, rows: SparseRows) -> Attachments:
    """Attachments of weighted sums of vertices, one per row; the weights must sum to one."""

    def combine(values: np.ndarray) -> np.ndarray:
        picked = values[rows.indices]
        weights = rows.weights.reshape(-1, *[1] * (values.ndim - 1))
        combined = np.add.reduceat(weights * picked, rows.pointers[:-1], axis=0)
        return combined.astype(np.float32)

    every = tangent.vertices
    return Attachments(
        part_weights=combine(every.part_weights),
        joint_follow=combine(every.joint_follow),
        shape_basis=combine(every.shape_basis),
    )


def linearise(tangent: TangentModel, parameters: BodyParameters) -> Linearisation:
    """The articulated frame at ``parameters``."""
    parents = tangent.model.part_parent
    rotations = global_rotations(parameters.pose, parents)
    rest = tangent.joints_mean + np.tensordot(parameters.shape, tangent.joints_derivative, axes=1)
    offsets = posed_joints(tangent.joints_derivative, rotations, parents) - np.einsum(
        "pij,npj->npi", rotations, tangent.joints_derivative
    )
    return Linearisation(
        translation=parameters.translation,
        rotations=rotations,
        parent_rotations=np.where((parents < 0)[:, None, None], np.eye(3), rotations[parents]),
        joints=posed_joints(rest, rotations, parents),
        joint_offsets=offsets,
    )
