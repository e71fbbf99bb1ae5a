"""A linear-blend tangent of the body: closed-form Jacobians for the Gauss-Newton matrix.

The exact Jacobian of SCAPE has 3 p + 3 + n columns of m vertices and would cost a solve each.
The optimiser needs it only to shape its steps; gradients come exact from
:meth:`fitter.body.scape.ScapeEvaluator.derivative`, and steps are accepted on the true energy.
So the columns are those of linear blend skinning about the posed joints, at chosen vertices only.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Vertices
from fitter.body.model import BodyModel
from fitter.body.scape import CAMERA_AXES
from fitter.body.shape_space import rest_combinations
from fitter.body.skeleton import dense_rows, descendants, global_rotations, posed_joints
from fitter.parameters import BodyParameters


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TangentModel:
    """What the tangent needs of a model, independent of shape and pose.

    Attributes
    ----------
    model
        The body model.
    part_weights
        (m, p) dense skinning weights.
    joint_follow
        (m, p) how far a vertex follows a turn of each joint: weights summed over descendants.
    joints_mean, joints_derivative
        Rest joints as an affine function of the shape, (p, 3) and (n, p, 3).
    """

    model: BodyModel
    part_weights: Float[np.ndarray, "m p"]
    joint_follow: Float[np.ndarray, "m p"]
    joints_mean: Float[np.ndarray, "p 3"]
    joints_derivative: Float[np.ndarray, "n p 3"]


def tangent_model(model: BodyModel) -> TangentModel:
    """Prepare a model's tangent."""
    m, p = len(model.mean_vertices), len(model.part_names)
    weights = np.zeros((m, p))
    np.add.at(weights, (np.arange(m)[:, None], model.skinning_parts), model.skinning_weights)
    weights /= weights.sum(axis=1, keepdims=True)
    mean, derivative = rest_combinations(model, dense_rows(model.joint_regressor, m))
    return TangentModel(
        model=model,
        part_weights=weights,
        joint_follow=weights @ descendants(model.part_parent).T,
        joints_mean=mean,
        joints_derivative=derivative,
    )


def vertex_jacobian(
    tangent: TangentModel,
    parameters: BodyParameters,
    vertices: Vertices,
    chosen: Integer[np.ndarray, " r"],
) -> Float[np.ndarray, "r 3 columns"]:
    """Approximate derivative of chosen camera-frame vertices by all body parameters.

    Columns are the pose increments (3 p, as in :class:`fitter.body.scape.BodyDerivative`), the
    translation (3) and the shape (n).

    Parameters
    ----------
    tangent
        From :func:`tangent_model`.
    parameters
        Where to linearise.
    vertices
        (m, 3) the evaluated camera-frame vertices there.
    chosen
        Vertex ids.
    """
    model = tangent.model
    p, n, r = len(model.part_names), len(parameters.shape), len(chosen)
    rotations = global_rotations(parameters.pose, model.part_parent)
    rest_joints = tangent.joints_mean + np.tensordot(
        parameters.shape, tangent.joints_derivative, axes=1
    )
    joints = posed_joints(rest_joints, rotations, model.part_parent)
    points = (vertices[chosen] - parameters.translation) * CAMERA_AXES
    jacobian = np.zeros((r, 3, 3 * p + 3 + n))

    parents = model.part_parent
    axes = np.where((parents < 0)[:, None, None], np.eye(3), rotations[parents])
    follow = tangent.joint_follow[chosen]
    arms = points[:, None, :] - joints[None]  # (r, p, 3)
    for axis in range(3):
        turned = np.cross(axes[None, :, :, axis], arms) * follow[:, :, None]
        jacobian[:, :, axis : 3 * p : 3] = (turned * CAMERA_AXES).transpose(0, 2, 1)
    jacobian[:, np.arange(3), 3 * p + np.arange(3)] = 1.0

    weights = tangent.part_weights[chosen]
    blended = np.tensordot(weights, rotations, axes=1)  # (r, 3, 3)
    carried = np.matmul(
        blended[:, None], model.shape_basis[:, chosen].transpose(1, 0, 2)[..., None]
    )
    offsets = np.stack(
        [
            posed_joints(derivative, rotations, parents)
            - np.einsum("pij,pj->pi", rotations, derivative)
            for derivative in tangent.joints_derivative
        ]
    )  # (n, p, 3)
    joint_part = np.tensordot(weights, offsets, axes=([1], [1]))  # (r, n, 3)
    shape_columns = (carried[..., 0] + joint_part) * CAMERA_AXES
    jacobian[:, :, 3 * p + 3 :] = shape_columns.transpose(0, 2, 1)
    return jacobian
