"""The tangent as whole Jacobians, beside which the compiled rows are tested."""

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Points3D
from fitter.body.scape import CAMERA_AXES
from fitter.body.tangent import Attachments, Linearisation, TangentModel


def attached_vertices(tangent: TangentModel, chosen: Integer[np.ndarray, " k"]) -> Attachments:
    """Attachments of chosen vertices."""
    every = tangent.vertices
    return Attachments(
        part_weights=every.part_weights[chosen],
        joint_follow=every.joint_follow[chosen],
        shape_basis=every.shape_basis[chosen],
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
