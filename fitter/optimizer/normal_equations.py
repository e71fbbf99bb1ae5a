"""The Gauss-Newton normal equations of one picture's objective at a candidate.

The gradient is exact for the rows: their derivatives by vertex positions and normals are pulled
back through the body by its reverse mode. The matrix uses the linear-blend tangent and only some of
the rows: it merely shapes the step.

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
from fitter.body.tangent import Attachments, linearise
from fitter.energies.fitting_operators import FittingOperators
from fitter.energies.objective import Candidate, Objective
from fitter.energies.rows import Nuisance, PositionRows, ShadingRows, Support, thinned
from fitter.energies.shading import thinned_shading
from fitter.numerics.normals import add_normal_derivative
from fitter.optimizer.free_space import as_vector
from fitter.optimizer.light_solve import light_nuisance
from fitter.optimizer.row_jacobians import (
    RowJacobian,
    position_row_jacobian,
    scatter,
    scatter_sums,
    shading_row_jacobian,
)


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
