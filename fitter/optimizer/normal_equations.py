"""The Gauss-Newton normal equations of an objective at a candidate.

The gradient is exact for the rows: their derivatives by vertex positions and normals are pulled
back through the body by its reverse mode. The matrix uses the linear-blend tangent, and few rows:
it only shapes the step.
"""

import numpy as np
from jaxtyping import Float

from fitter.arrays import Points3D, Vertices
from fitter.body.model import SparseRows
from fitter.body.pose_prior import prior_terms
from fitter.body.tangent import (
    Attachments,
    Linearisation,
    attached_rows,
    attached_vertices,
    direction_jacobian,
    linearise,
    point_jacobian,
)
from fitter.energies.clicks import click_rows
from fitter.energies.edges import edge_rows
from fitter.energies.objective import Candidate, Objective
from fitter.energies.penetration import penetration_rows
from fitter.energies.priors import lean_residual, shape_prior_precision
from fitter.energies.rows import PositionRows, ShadingRows, thinned
from fitter.energies.shading import shading_rows, thinned_shading
from fitter.energies.silhouette import silhouette_rows
from fitter.numerics.normals import normal_change, normal_derivative_to_vertices
from fitter.optimizer.parameter_vector import as_vector

# Rows of each kind that enter the matrix; the gradient uses all of them.
_MATRIX_ROWS = 600
_MATRIX_SHADING_ROWS = 500

Matrix = Float[np.ndarray, "columns columns"]
Vector = Float[np.ndarray, " columns"]


def normal_equations(objective: Objective, candidate: Candidate) -> tuple[Matrix, Vector]:
    """Matrix and gradient over the full parameter vector, in nats."""
    instruments, evidence, scales = objective.instruments, objective.evidence, objective.scales
    tangent = instruments.tangent
    frame = linearise(tangent, candidate.parameters)
    rendering, parameters = candidate.rendering, candidate.parameters
    on_vertices = [
        *silhouette_rows(rendering, candidate.edges, evidence.silhouette, scales),
        edge_rows(rendering, candidate.edges, evidence.edges, scales),
    ]
    clicks = click_rows(candidate.landmarks, evidence.clicks, evidence.camera, scales)
    spheres = penetration_rows(candidate.spheres, candidate.radii, instruments.penetration, scales)

    pull = np.zeros_like(candidate.vertices)
    columns = parameters.pose.size + 3 + len(parameters.shape)
    matrix = np.zeros((columns, columns))
    for rows in on_vertices:
        _scatter(rows, pull)
        few = thinned(rows, _MATRIX_ROWS)
        chosen, index = np.unique(few.points, return_inverse=True)
        jacobian = point_jacobian(
            frame, attached_vertices(tangent, chosen), candidate.vertices[chosen]
        )
        matrix += _gram(few, index.reshape(few.points.shape), jacobian)
    for rows, support, attachments, positions in (
        (
            clicks,
            evidence.clicks.landmarks,
            attached_rows(tangent, evidence.clicks.landmarks),
            candidate.landmarks,
        ),
        (
            spheres,
            instruments.penetration.centres,
            instruments.sphere_attachments,
            candidate.spheres,
        ),
    ):
        if not len(rows.residuals):
            continue
        _scatter_through(rows, support, len(positions), pull)
        jacobian = point_jacobian(frame, attachments, positions)
        matrix += _gram(rows, rows.points, jacobian)
    if evidence.shading is not None:
        rows = shading_rows(rendering, evidence.shading, scales)
        pull += _shading_pull(objective, candidate, rows)
        matrix += _shading_gram(objective, candidate, rows, frame)

    gradient = as_vector(instruments.evaluator.derivative(parameters, pull))
    _add_priors(objective, candidate, matrix, gradient)
    return matrix, gradient


def _add_priors(
    objective: Objective, candidate: Candidate, matrix: Matrix, gradient: Vector
) -> None:
    """Add the exact quadratic forms of the priors in place."""
    parameters = candidate.parameters
    pose_size = parameters.pose.size
    terms = prior_terms(objective.instruments.pose_prior, parameters.pose)
    blocks = np.einsum("pra,prb->pab", terms.jacobian, terms.jacobian)
    for part, block in enumerate(blocks):
        span = slice(3 * part, 3 * part + 3)
        matrix[span, span] += block
    gradient[:pose_size] += np.einsum("pra,pr->pa", terms.jacobian, terms.residuals).ravel()
    lean, by_root = lean_residual(parameters.pose)
    matrix[:3, :3] += np.outer(by_root, by_root)
    gradient[:3] += lean * by_root
    precision = shape_prior_precision(len(parameters.shape))
    shape = slice(pose_size + 3, None)
    matrix[shape, shape] += np.diag(precision)
    gradient[shape] += precision * parameters.shape


def _scatter(rows: PositionRows, pull: Vertices) -> None:
    """Add w r ∂r to the points' derivative."""
    force = (rows.weights * rows.residuals)[:, None, None] * rows.derivatives
    np.add.at(pull, rows.points.reshape(-1), force.reshape(-1, 3))


def _scatter_through(rows: PositionRows, support: SparseRows, count: int, pull: Vertices) -> None:
    """The same for points that are weighted sums of vertices."""
    on_points = np.zeros((count, 3))
    _scatter(rows, on_points)
    lengths = np.diff(support.pointers)
    np.add.at(
        pull, support.indices, np.repeat(on_points, lengths, axis=0) * support.weights[:, None]
    )


def _gram(
    rows: PositionRows, index: np.ndarray, jacobian: Float[np.ndarray, "u 3 columns"]
) -> Matrix:
    """Jᵀ W J of rows whose points are rows of ``jacobian``."""
    combined = np.einsum("kqi,kqic->kc", rows.derivatives, jacobian[index], optimize=True)
    return combined.T @ (rows.weights[:, None] * combined)


def _shading_pull(objective: Objective, candidate: Candidate, rows: ShadingRows) -> Vertices:
    force = (rows.weights * rows.residuals)[:, None]
    pull = np.zeros_like(candidate.vertices)
    pull[rows.vertices] = force * rows.position_derivatives
    by_normal = np.zeros_like(pull)
    by_normal[rows.vertices] = force * rows.normal_derivatives
    triangles = objective.instruments.model.triangles
    return pull + normal_derivative_to_vertices(candidate.vertices, triangles, by_normal)


def _shading_gram(
    objective: Objective, candidate: Candidate, rows: ShadingRows, frame: Linearisation
) -> Matrix:
    instruments = objective.instruments
    few = thinned_shading(rows, _MATRIX_SHADING_ROWS)
    attachments: Attachments = attached_vertices(instruments.tangent, few.vertices)
    by_position = point_jacobian(frame, attachments, candidate.vertices[few.vertices])
    rest: Points3D = instruments.model.mean_vertices + np.tensordot(
        candidate.parameters.shape, instruments.model.shape_basis, axes=1
    )
    change = normal_change(
        rest,
        instruments.model.triangles,
        instruments.rings,
        few.vertices,
        instruments.model.shape_basis,
    )
    by_normal = direction_jacobian(
        frame, attachments, candidate.rendering.vertex_normals[few.vertices], change
    )
    combined = np.einsum("ki,kic->kc", few.position_derivatives, by_position) + np.einsum(
        "ki,kic->kc", few.normal_derivatives, by_normal
    )
    return combined.T @ (few.weights[:, None] * combined)
