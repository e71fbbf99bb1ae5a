"""The Gauss-Newton normal equations of one picture's objective at a candidate.

The gradient is exact for the rows: their derivatives by vertex positions and normals are pulled
back through the body by its reverse mode. The matrix uses the linear-blend tangent and only some of
the rows: it merely shapes the step. The derivative of a point by every parameter is never stored:
each row's own is taken straight through the tangent (:mod:`fitter.optimizer._row_kernels`), in a
twentieth of the time.

With A = √W J the rows' derivatives by the body, T = √W ∂r those by their other unknowns, and P the
rows of what is known of these, body and unknowns as one vector have the normal matrix

    M     AᵀT          M of everything else by the body, and AᵀA
    TᵀA   D            D = TᵀT + PᵀP

Eliminating the unknowns leaves M - AᵀT D⁻¹ TᵀA, in which the rows' own part AᵀA becomes BᵀB of

    B = [ A - T R ]
        [   - P R ],        R = D⁻¹ TᵀA.

With C, the inverse of what is left, the unknowns' covariance is D⁻¹ + R C Rᵀ.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from fitter.arrays import Points3D, Vertices
from fitter.body.model import SparseRows
from fitter.body.pose_prior import PriorTerms
from fitter.body.tangent import Attachments, Linearisation, linearise
from fitter.energies.fitting_operators import FittingOperators
from fitter.energies.objective import Candidate, Objective
from fitter.energies.rows import Nuisance, PositionRows, ShadingRows, Support, thinned
from fitter.energies.shading import thinned_shading
from fitter.numerics.meshes import add_normal_derivative
from fitter.optimizer import _row_kernels as kernels
from fitter.optimizer.free_space import as_vector
from fitter.optimizer.light_solve import light_nuisance

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


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RowsWithNuisance:
    """Rows of one kind: A (k, columns), the weights (k,) and the other unknowns."""

    by_body: RowJacobian
    weights: Float[np.ndarray, " k"]
    nuisance: Nuisance

    @property
    def by_nuisance(self) -> Float[np.ndarray, "k u"]:
        """T."""
        return np.sqrt(self.weights)[:, None] * self.nuisance.slopes


def without_nuisance(kinds: Sequence[RowsWithNuisance]) -> RowJacobian:
    """B of all rows that share their other unknowns."""
    _, response = _own_and_response(kinds)
    left = [each.by_body - each.by_nuisance @ response for each in kinds]
    return np.concatenate([*left, -kinds[0].nuisance.known @ response])


def nuisance_covariance(
    rows: RowsWithNuisance, body_covariance: Float[np.ndarray, "columns columns"]
) -> Float[np.ndarray, "u u"]:
    """Covariance of the other unknowns, with the body marginalised.

    ``body_covariance`` C is that of all body parameters with these unknowns marginalised.
    """
    own, response = _own_and_response([rows])
    covariance = np.linalg.inv(own) + response @ body_covariance @ response.T
    return 0.5 * (covariance + covariance.T)


def _own_and_response(
    kinds: Sequence[RowsWithNuisance],
) -> tuple[Float[np.ndarray, "u u"], Float[np.ndarray, "u columns"]]:
    """D and R."""
    known = kinds[0].nuisance.known
    own, mixed = known.T @ known, 0.0
    for each in kinds:
        by_nuisance = each.by_nuisance
        own = own + by_nuisance.T @ by_nuisance
        mixed = mixed + by_nuisance.T @ each.by_body
    return own, np.linalg.solve(own, mixed)


# At most this many rows of each kind enter the matrix; the gradient uses all of them.
MATRIX_ROWS = 300
MATRIX_SHADING_ROWS = 300

Matrix = Float[np.ndarray, "columns columns"]
Vector = Float[np.ndarray, " columns"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SupportPoints:
    """Points that rows depend on.

    Attributes
    ----------
    sums
        Which weighted sums of vertices they are; None for the vertices themselves.
    attachments
        How they are attached to the body.
    positions
        Where they are, camera frame, metres.
    """

    sums: SparseRows | None
    attachments: Attachments
    positions: Points3D


def normal_equations(
    objective: Objective, candidate: Candidate, *, marginal: bool = False
) -> tuple[Matrix, Vector]:
    """Matrix and gradient over the full parameter vector, in nats.

    The matrix treats what rows depend on besides the body as free, but for what the energy holds;
    with ``marginal``, that too.
    """
    operators, parameters = objective.operators, candidate.parameters
    frame = linearise(operators.tangent, parameters)
    points = support_points(objective, candidate)
    pull, by_centre = np.zeros_like(candidate.vertices), np.zeros(3)
    jacobians: list[RowJacobian] = []
    with_nuisance: dict[str, list[RowsWithNuisance]] = {}
    priors: list[PriorTerms] = []
    for rows in (rows for term in objective.terms for rows in term.rows(candidate)):
        if isinstance(rows, PriorTerms):
            priors.append(rows)
            continue
        if not len(rows.residuals):
            continue
        if isinstance(rows, ShadingRows):
            by_centre += rows.centre_derivatives.T @ (rows.weights * rows.residuals)
            _add_shading_pull(objective, candidate, rows, pull)
            few = thinned_shading(rows, MATRIX_SHADING_ROWS)
            jacobian = shading_row_jacobian(few, frame, operators, candidate)
            evidence = objective.evidence.shading
            assert evidence is not None
            nuisance = light_nuisance(candidate, evidence, few) if marginal else None
        else:
            on = points[rows.support]
            _add_pull(rows, on, pull)
            few = thinned(rows, MATRIX_ROWS)
            jacobian = position_row_jacobian(few, frame, on.attachments, on.positions)
            nuisance = few.nuisance
        if nuisance is None or (nuisance.held_in_search and not marginal):
            jacobians.append(jacobian)
        else:
            with_nuisance.setdefault(nuisance.name, []).append(
                RowsWithNuisance(by_body=jacobian, weights=few.weights, nuisance=nuisance)
            )
    jacobians += [without_nuisance(kinds) for kinds in with_nuisance.values()]
    columns = parameters.pose.size + len(parameters.translation) + len(parameters.shape)
    every = np.concatenate([np.zeros((0, columns)), *jacobians])
    matrix = every.T @ every
    derivative = operators.evaluator.derivative(parameters, pull)
    gradient = as_vector(replace(derivative, translation=derivative.translation + by_centre))
    for terms in priors:
        _add_prior(terms, matrix, gradient)
    return matrix, gradient


def support_points(objective: Objective, candidate: Candidate) -> Mapping[Support, SupportPoints]:
    """The points that rows may depend on, at a candidate."""
    operators, clicked = objective.operators, objective.evidence.clicks.landmarks
    return {
        Support.VERTICES: SupportPoints(
            sums=None, attachments=operators.tangent.vertices, positions=candidate.vertices
        ),
        Support.LANDMARKS: SupportPoints(
            sums=clicked,
            attachments=_attachments_of(operators, clicked.names),
            positions=candidate.landmarks,
        ),
        Support.SPHERES: SupportPoints(
            sums=operators.penetration.centres,
            attachments=operators.sphere_attachments,
            positions=candidate.spheres,
        ),
        Support.JOINTS: SupportPoints(
            sums=operators.model.joint_regressor,
            attachments=operators.joint_attachments,
            positions=candidate.joints,
        ),
    }


def _attachments_of(operators: FittingOperators, names: tuple[str, ...]) -> Attachments:
    every, order = operators.landmark_attachments, operators.model.landmarks.names
    rows = [order.index(name) for name in names]
    return Attachments(
        part_weights=every.part_weights[rows],
        joint_follow=every.joint_follow[rows],
        shape_basis=every.shape_basis[rows],
    )


def _add_prior(terms: PriorTerms, matrix: Matrix, gradient: Vector) -> None:
    """Add the quadratic form of a prior on the pose, in place."""
    blocks = np.einsum("pra,prb->pab", terms.jacobian, terms.jacobian)
    for part, block in enumerate(blocks):
        span = slice(3 * part, 3 * part + 3)
        matrix[span, span] += block
    pulls = np.einsum("pra,pr->pa", terms.jacobian, terms.residuals).ravel()
    gradient[: len(pulls)] += pulls


def _add_pull(rows: PositionRows, on: SupportPoints, pull: Vertices) -> None:
    """Add w r ∂r to the derivative by the vertices, in place."""
    if on.sums is None:
        scatter(rows, pull)
        return
    on_points = np.zeros_like(on.positions)
    scatter(rows, on_points)
    scatter_sums(on_points, on.sums, pull)


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
