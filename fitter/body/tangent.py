"""A linear-blend tangent of the body: closed-form Jacobians for the Gauss-Newton matrix.

The exact Jacobian of SCAPE has 3 p + 3 + n columns of m vertices and would cost a solve each.
The optimiser needs it only to shape its steps; gradients come exact from
:meth:`fitter.body.scape.ScapeEvaluator.derivative`, and steps are accepted on the true energy.
So the columns are those of linear blend skinning about the posed joints, at chosen points only:
vertices, or weighted sums of vertices such as landmarks.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Points3D, Rotations
from fitter.body.model import (
    BodyModel,
    SparseRows,
    dense_rows,
    descendants,
    global_rotations,
    posed_joints,
)
from fitter.body.scape import CAMERA_AXES
from fitter.body.shape_space import rest_combinations
from fitter.parameters import BodyParameters


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Attachments:
    """How k points are attached to the body; in single precision, to halve what a search reads.

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
    """What the tangent needs from a model, independent of shape and pose.

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


def attached_vertices(tangent: TangentModel, chosen: Integer[np.ndarray, " k"]) -> Attachments:
    """Attachments of chosen vertices."""
    every = tangent.vertices
    return Attachments(
        part_weights=every.part_weights[chosen],
        joint_follow=every.joint_follow[chosen],
        shape_basis=every.shape_basis[chosen],
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


def point_jacobian(
    frame: Linearisation, attachments: Attachments, points: Points3D
) -> Float[np.ndarray, "k 3 columns"]:
    """Approximate derivative of camera-frame points by all body parameters.

    Columns are the pose increments (3 p, as in :class:`fitter.body.scape.BodyDerivative`), the
    translation (3) and the shape (n).

    Parameters
    ----------
    frame
        From :func:`linearise`.
    attachments
        How the points are attached to the body.
    points
        (k, 3) their positions now, camera frame, metres.
    """
    k, p = attachments.part_weights.shape
    n = attachments.shape_basis.shape[1]
    jacobian = np.zeros((k, 3, 3 * p + 3 + n))
    arms = (points - frame.translation)[:, None, :] * CAMERA_AXES - frame.joints[None]
    arms *= attachments.joint_follow[:, :, None]
    for axis in range(3):
        direction = frame.parent_rotations[:, :, axis]  # (p, 3)
        for c in range(3):
            after, last = (c + 1) % 3, (c + 2) % 3
            turned = direction[:, after] * arms[:, :, last] - direction[:, last] * arms[:, :, after]
            jacobian[:, c, axis : 3 * p : 3] = turned * CAMERA_AXES[c]
    jacobian[:, np.arange(3), 3 * p + np.arange(3)] = 1.0
    blended = np.tensordot(attachments.part_weights, frame.rotations, axes=1)
    carried = np.matmul(blended, attachments.shape_basis.transpose(0, 2, 1))  # (k, 3, n)
    offset = np.tensordot(attachments.part_weights, frame.joint_offsets, axes=([1], [1]))
    jacobian[:, :, 3 * p + 3 :] = (carried + offset.transpose(0, 2, 1)) * CAMERA_AXES[:, None]
    return jacobian


def direction_jacobian(
    frame: Linearisation,
    attachments: Attachments,
    directions: Points3D,
    rest_change: Float[np.ndarray, "k n 3"],
) -> Float[np.ndarray, "k 3 columns"]:
    """Approximate derivative of camera-frame unit vectors carried by the body, such as normals.

    Parameters
    ----------
    frame, attachments
        As in :func:`point_jacobian`.
    directions
        (k, 3) the vectors now, camera frame.
    rest_change
        (k, n, 3) their change with each shape coefficient on the body at rest, body frame.
    """
    k, p = attachments.part_weights.shape
    n = attachments.shape_basis.shape[1]
    jacobian = np.zeros((k, 3, 3 * p + 3 + n))
    body = directions * CAMERA_AXES
    for axis in range(3):
        turn = frame.parent_rotations[:, :, axis]
        for c in range(3):
            after, last = (c + 1) % 3, (c + 2) % 3
            turned = (
                turn[None, :, after] * body[:, None, last]
                - turn[None, :, last] * body[:, None, after]
            )
            jacobian[:, c, axis : 3 * p : 3] = turned * attachments.joint_follow * CAMERA_AXES[c]
    blended = np.tensordot(attachments.part_weights, frame.rotations, axes=1)
    carried = np.matmul(blended, rest_change.transpose(0, 2, 1))
    jacobian[:, :, 3 * p + 3 :] = carried * CAMERA_AXES[:, None]
    return jacobian
