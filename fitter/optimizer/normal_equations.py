"""The Gauss-Newton normal equations of one picture's objective at a candidate.

The gradient is exact for the rows: their derivatives by vertex positions and normals are pulled
back through the body by its reverse mode. The matrix uses the linear-blend tangent and only some of
the rows: it merely shapes the step.
"""

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from fitter.arrays import Vertices
from fitter.body.model import SparseRows
from fitter.body.pose_prior import prior_terms
from fitter.body.tangent import Attachments, linearise
from fitter.energies.clicks import click_rows
from fitter.energies.correspondence_lines import line_rows
from fitter.energies.edges import edge_rows
from fitter.energies.fitting_operators import FittingOperators
from fitter.energies.limb_slants import slant_rows
from fitter.energies.objective import Candidate, Objective
from fitter.energies.penetration import penetration_rows
from fitter.energies.rows import PositionRows, ShadingRows, thinned
from fitter.energies.shading import shading_rows, thinned_shading
from fitter.energies.silhouette import silhouette_rows
from fitter.energies.stance import stance_rows
from fitter.numerics.normals import add_normal_derivative
from fitter.optimizer.ease_freedom import with_free_ease
from fitter.optimizer.parameter_vector import as_vector
from fitter.optimizer.row_jacobians import (
    RowJacobian,
    position_row_jacobian,
    scatter,
    scatter_sums,
    shading_row_jacobian,
)
from fitter.optimizer.tilt_freedom import stance_jacobian, with_free_tilt

# At most this many rows of each kind enter the matrix; the gradient uses all of them.
MATRIX_ROWS = 300
MATRIX_SHADING_ROWS = 300

Matrix = Float[np.ndarray, "columns columns"]
Vector = Float[np.ndarray, " columns"]


def normal_equations(
    objective: Objective, candidate: Candidate, *, marginal: bool = False
) -> tuple[Matrix, Vector]:
    """Matrix and gradient over the full parameter vector, in nats.

    The matrix treats the ease that all loose clothes share as free wherever the energy takes its
    most probable value, as that of lines does; with ``marginal``, also where the energy holds it.
    """
    operators, evidence, scales = objective.operators, objective.evidence, objective.scales
    rendering, parameters = candidate.rendering, candidate.parameters
    frame = linearise(operators.tangent, parameters)
    pull, by_centre = np.zeros_like(candidate.vertices), np.zeros(3)
    jacobians: list[RowJacobian] = []
    eases: list[tuple[RowJacobian, PositionRows]] = []
    for rows in (
        *outline_rows(objective, candidate),
        edge_rows(rendering, candidate.edges, evidence.edges, scales, evidence.bare),
    ):
        scatter(rows, pull)
        few = thinned(rows, MATRIX_ROWS)
        vertices = operators.tangent.vertices
        jacobian = position_row_jacobian(few, frame, vertices, candidate.vertices)
        if rows.of_ease and (marginal or evidence.lines is not None):
            eases.append((jacobian, few))
        else:
            jacobians.append(jacobian)
    if eases:
        jacobians.append(with_free_ease(eases, scales))
    on_landmarks = [click_rows(candidate.landmarks, evidence.clicks, evidence.camera, scales)]
    if evidence.slants is not None:
        on_landmarks.append(slant_rows(candidate.landmarks, evidence.slants))
    landmark_attachments = _attachments_of(operators, evidence.clicks.landmarks.names)
    for rows, support, attachments, positions in (
        *(
            (rows, evidence.clicks.landmarks, landmark_attachments, candidate.landmarks)
            for rows in on_landmarks
        ),
        (
            penetration_rows(candidate.spheres, candidate.radii, operators.penetration, scales),
            operators.penetration.centres,
            operators.sphere_attachments,
            candidate.spheres,
        ),
    ):
        if not len(rows.residuals):
            continue
        _scatter_through(rows, support, len(positions), pull)
        jacobians.append(position_row_jacobian(rows, frame, attachments, positions))
    stance = stance_rows(candidate.joints, operators.stance_vectors, candidate.tilt)
    _scatter_through(stance.rows, operators.model.joint_regressor, len(candidate.joints), pull)
    jacobians.append(with_free_tilt(stance_jacobian(stance, frame, operators, candidate), stance))
    if evidence.shading is not None:
        rows = shading_rows(rendering, evidence.shading.about(parameters.translation), scales)
        by_centre += rows.centre_derivatives.T @ (rows.weights * rows.residuals)
        _add_shading_pull(objective, candidate, rows, pull)
        few = thinned_shading(rows, MATRIX_SHADING_ROWS)
        jacobians.append(shading_row_jacobian(few, frame, operators, candidate))
    every = np.concatenate(jacobians)
    matrix = every.T @ every
    derivative = operators.evaluator.derivative(parameters, pull)
    gradient = as_vector(replace(derivative, translation=derivative.translation + by_centre))
    _add_pose_prior(objective, candidate, matrix, gradient)
    return matrix, gradient


def outline_rows(objective: Objective, candidate: Candidate) -> tuple[PositionRows, ...]:
    """Rows of the silhouette energy: those of its lines, or of the segmented region."""
    evidence, scales = objective.evidence, objective.scales
    if evidence.lines is not None:
        return line_rows(candidate.rendering, evidence.lines, scales)
    return silhouette_rows(candidate.rendering, candidate.edges, evidence.silhouette, scales)


def _attachments_of(operators: FittingOperators, names: tuple[str, ...]) -> Attachments:
    every, order = operators.landmark_attachments, operators.model.landmarks.names
    rows = [order.index(name) for name in names]
    return Attachments(
        part_weights=every.part_weights[rows],
        joint_follow=every.joint_follow[rows],
        shape_basis=every.shape_basis[rows],
    )


def _add_pose_prior(
    objective: Objective, candidate: Candidate, matrix: Matrix, gradient: Vector
) -> None:
    """Add the quadratic form of the prior on the pose, in place."""
    parameters = candidate.parameters
    pose_size = parameters.pose.size
    terms = prior_terms(objective.operators.pose_prior, parameters.pose)
    blocks = np.einsum("pra,prb->pab", terms.jacobian, terms.jacobian)
    for part, block in enumerate(blocks):
        span = slice(3 * part, 3 * part + 3)
        matrix[span, span] += block
    gradient[:pose_size] += np.einsum("pra,pr->pa", terms.jacobian, terms.residuals).ravel()


def _scatter_through(rows: PositionRows, support: SparseRows, count: int, pull: Vertices) -> None:
    """:func:`scatter` for points that are weighted sums of vertices."""
    on_points = np.zeros((count, 3))
    scatter(rows, on_points)
    scatter_sums(on_points, support, pull)


def _add_shading_pull(
    objective: Objective, candidate: Candidate, rows: ShadingRows, pull: Vertices
) -> None:
    force = (rows.weights * rows.residuals)[:, None]
    # No vertex has two rows.
    pull[rows.vertices] += force * rows.position_derivatives
    operators = objective.operators
    add_normal_derivative(
        candidate.vertices,
        operators.model.triangles,
        operators.rings,
        rows.vertices,
        force * rows.normal_derivatives,
        pull,
    )
