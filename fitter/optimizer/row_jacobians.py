"""Rows of the Gauss-Newton matrix: residuals' derivatives by all body parameters.

The derivative of a point by every parameter is never stored: each row's own derivative is taken
straight through the linear-blend tangent (:mod:`fitter.optimizer._row_kernels`), in a twentieth of
the time.
"""

import numpy as np
from jaxtyping import Float

from fitter.arrays import Points3D, Vertices
from fitter.body.model import SparseRows
from fitter.body.tangent import Attachments, Linearisation
from fitter.energies.fitting_operators import FittingOperators
from fitter.energies.objective import Candidate
from fitter.energies.rows import PositionRows, ShadingRows
from fitter.optimizer import _row_kernels as kernels

RowJacobian = Float[np.ndarray, "rows columns"]


def position_row_jacobian(
    rows: PositionRows, frame: Linearisation, attachments: Attachments, positions: Points3D
) -> RowJacobian:
    """√w ∂r of each row; columns: pose increments (3 p), translation (3), shape (n).

    Parameters
    ----------
    rows
        Their points index ``attachments`` and ``positions``.
    frame
        The body they were taken at.
    attachments, positions
        How the points are attached to the body, and where they are, camera frame, metres.
    """
    result = _empty(len(rows.residuals), frame)
    kernels.position_row_jacobian(
        # Strided ones would be compiled for anew, in the middle of a fit.
        np.ascontiguousarray(rows.derivatives),
        np.ascontiguousarray(rows.points),
        np.sqrt(rows.weights),
        _points(positions, attachments),
        _frame(frame),
        result,
    )
    return result


def shading_row_jacobian(
    rows: ShadingRows, frame: Linearisation, operators: FittingOperators, candidate: Candidate
) -> RowJacobian:
    """√w ∂r of each row, through the vertex and through its normal.

    The normal turns with the body, and changes with the shape as it does on the body at rest. The
    light moves with the root joint.
    """
    model = operators.model
    rest = model.mean_vertices + np.tensordot(candidate.parameters.shape, model.shape_basis, axes=1)
    result = _empty(len(rows.residuals), frame)
    kernels.shading_row_jacobian(
        rows.position_derivatives,
        rows.normal_derivatives,
        rows.vertices,
        np.sqrt(rows.weights),
        candidate.rendering.vertex_normals,
        _points(candidate.vertices, operators.tangent.vertices),
        _frame(frame),
        kernels.Rest(
            vertices=rest,
            triangles=model.triangles,
            pointers=operators.rings.pointers,
            rings=operators.rings.triangles,
        ),
        result,
    )
    place = slice(3 * len(frame.joints), 3 * len(frame.joints) + 3)
    result[:, place] += np.sqrt(rows.weights)[:, None] * rows.centre_derivatives
    return result


def scatter(rows: PositionRows, derivative: Vertices) -> None:
    """Add w r ∂r to the derivative at the rows' points, in place."""
    kernels.scatter(rows.weights * rows.residuals, rows.points, rows.derivatives, derivative)


def scatter_sums(by_sums: Points3D, support: SparseRows, derivative: Vertices) -> None:
    """Pull a derivative by weighted sums of vertices back to the vertices, in place."""
    kernels.scatter_sums(by_sums, support.pointers, support.indices, support.weights, derivative)


def _points(positions: Points3D, attachments: Attachments) -> kernels.Points:
    return kernels.Points(
        positions=positions,
        joint_follow=attachments.joint_follow,
        part_weights=attachments.part_weights,
        shape_basis=attachments.shape_basis,
    )


def _frame(frame: Linearisation) -> kernels.Frame:
    return kernels.Frame(
        translation=frame.translation,
        rotations=frame.rotations,
        parent_rotations=frame.parent_rotations,
        joints=frame.joints,
        joint_offsets=frame.joint_offsets,
    )


def _empty(count: int, frame: Linearisation) -> RowJacobian:
    return np.empty((count, 3 * len(frame.joints) + 3 + len(frame.joint_offsets)))
