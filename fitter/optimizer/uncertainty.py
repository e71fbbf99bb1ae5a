"""Certainty of shape and tilt: the Laplace approximation at the final bodies.

Energies are negative log-likelihoods, so the inverse of the Gauss-Newton matrix is the covariance
of all parameters near the minimum. The albedo of each vertex is held, as is everything else the
objective fixes. What is held exactly does not vary.
"""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from jaxtyping import Float

from fitter.arrays import Shape
from fitter.body.tangent import linearise
from fitter.energies.correspondence_lines import line_rows
from fitter.energies.fitting_operators import FittingOperators
from fitter.energies.objective import Candidate, JointCandidate, JointObjective, Objective
from fitter.energies.shape_terms import height_extrapolation
from fitter.energies.stance import stance_rows
from fitter.optimizer.free_space import FreeSpace, free_space
from fitter.optimizer.normal_equations import (
    RowsWithNuisance,
    normal_equations,
    nuisance_covariance,
    position_row_jacobian,
    support_points,
)
from fitter.parameters import CameraTilt
from fitter.vocabulary.choices import BodyRegion
from fitter.vocabulary.outcomes import StanceKind

_FEWEST_LINES: Final = 5.0


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Certainty:
    """Certainty of the body in one picture, given all, with light and ease marginalised.

    Attributes
    ----------
    operators, candidate
        Whose.
    covariance
        Of all its parameters, (columns, columns); the height does not vary.
    height_response
        (n,) how the most probable shape changes with the height coefficient.
    """

    operators: FittingOperators
    candidate: Candidate
    covariance: Float[np.ndarray, "columns columns"]
    height_response: Shape


def certainty(objective: JointObjective, candidate: JointCandidate) -> tuple[Certainty, ...]:
    """Certainty of each picture's body, given all pictures.

    The information about the shape is what every picture says of it once its own pose and place
    are eliminated, weighted, and what was known; the shape's covariance is its inverse Σ. With a
    picture's own blocks A and B of :mod:`fitter.optimizer.joint_equations`, the covariance of its
    pose and place is A⁻¹ + G Σ Gᵀ and that with the shape G Σ, where G = -A⁻¹ B.
    """
    shape = candidate.shape
    n = len(shape)
    space = free_space(objective.attributes.held, shape)
    directions = space.directions
    known, _ = objective.shape_equations(shape)
    information = known
    inverses: list[Float[np.ndarray, "own own"]] = []
    responses: list[Float[np.ndarray, "own free"]] = []
    for view, seen in zip(objective.views, candidate.views, strict=True):
        own = objective.weight * body_information(view, seen)
        inverse = np.linalg.inv(own[:-n, :-n])
        border = own[:-n, -n:]
        information = information + own[-n:, -n:] - border.T @ inverse @ border
        inverses.append(inverse)
        responses.append(-inverse @ border @ directions)
    free = np.linalg.inv(directions.T @ information @ directions)
    by_height = _height_response(space, information)
    certain: list[Certainty] = []
    for view, seen, inverse, response in zip(
        objective.views, candidate.views, inverses, responses, strict=True
    ):
        spread = np.concatenate([response, directions])
        covariance = spread @ free @ spread.T
        covariance[:-n, :-n] += inverse
        certain.append(
            Certainty(
                operators=view.operators,
                candidate=seen,
                covariance=covariance,
                height_response=by_height,
            )
        )
    return tuple(certain)


def body_information(
    objective: Objective, candidate: Candidate
) -> Float[np.ndarray, "columns columns"]:
    """Information of a picture on all its body's parameters, light and ease marginalised."""
    matrix, _ = normal_equations(objective, candidate, marginal=True)
    return matrix


def shape_covariance(certain: Certainty, *, height_variance: float) -> Float[np.ndarray, "n n"]:
    """Covariance of the shape, with pose and position marginalised.

    The height is never estimated from the picture: ``height_variance`` is the population's, given
    what is known, in its coefficient's unit; zero for a height that is known. Beyond usual heights
    all is wider (:func:`fitter.energies.shape_terms.height_extrapolation`).
    """
    response = certain.height_response
    n = len(response)
    covariance = certain.covariance[-n:, -n:] + height_variance * np.outer(response, response)
    return height_extrapolation(float(certain.candidate.parameters.shape[0])) * covariance


def camera_tilt(certain: Certainty) -> CameraTilt:
    """The camera's tilt, as the body tells it, with its covariance."""
    operators, candidate = certain.operators, certain.candidate
    tilt = candidate.tilt
    rows = stance_rows(candidate.joints, operators.stance_vectors, tilt)
    assert rows.nuisance is not None
    stance = RowsWithNuisance(
        by_body=position_row_jacobian(
            rows,
            linearise(operators.tangent, candidate.parameters),
            operators.joint_attachments,
            candidate.joints,
        ),
        weights=rows.weights,
        nuisance=rows.nuisance,
    )
    return CameraTilt(
        pitch=tilt.pitch,
        roll=tilt.roll,
        covariance=nuisance_covariance(stance, certain.covariance),
        stances=dict(zip(StanceKind, tilt.shares.tolist(), strict=True)),
    )


def covered_distances(
    objective: Objective, certain: Certainty
) -> dict[BodyRegion, tuple[float, float]]:
    """Distance of the outline from the body under loose cloth, and its standard error, metres.

    The mean over the lines of upper body and legs, each counted as far as it shows cloth. Empty
    where the outline was not found on lines; regions that show none are left out.
    """
    lines, candidate = objective.evidence.lines, certain.candidate
    found: dict[BodyRegion, tuple[float, float]] = {}
    if lines is None or not lines.cloth.any():
        return found
    outline = line_rows(candidate.rendering, lines, objective.scales)[0]
    frame = linearise(certain.operators.tangent, candidate.parameters)
    on = support_points(objective, candidate)[outline.support]
    shares = lines.fullness / np.maximum(lines.fullness.sum(axis=1, keepdims=True), 1e-9)
    pixels_per_metre = objective.scales.pixels_per_metre
    for region, share in zip((BodyRegion.UPPER, BodyRegion.LOWER), shares.T, strict=True):
        weights = lines.confidence * lines.cloth * share
        if weights.sum() < _FEWEST_LINES:
            continue
        weights = weights / weights.sum()
        # Rows are weighted by the roots of their weights.
        means = replace(outline, weights=weights**2, nuisance=None)
        by_body = position_row_jacobian(means, frame, on.attachments, on.positions).sum(axis=0)
        variance = float(by_body @ certain.covariance @ by_body)
        found[region] = (
            -float(weights @ outline.residuals) / pixels_per_metre,
            variance**0.5 / pixels_per_metre,
        )
    return found


def waist_distance(objective: Objective, candidate: Candidate) -> float | None:
    """Mean distance of the outline from the body beside the waist, metres; None without cloth."""
    lines, model = objective.evidence.lines, objective.operators.model
    if lines is None:
        return None
    is_waist = model.skinning_parts[lines.points] == model.part_names.index("spine")
    of_waist = (is_waist * model.skinning_weights[lines.points]).mean(axis=1).sum(axis=1)
    weights = lines.confidence * lines.cloth * of_waist
    if weights.sum() < 1.0:
        return None
    residuals = line_rows(candidate.rendering, lines, objective.scales)[0].residuals
    return -float(weights @ residuals / weights.sum()) / objective.scales.pixels_per_metre


def _height_response(space: FreeSpace, information: Float[np.ndarray, "n n"]) -> Shape:
    """Change of the most probable shape with the height coefficient.

    What is held is kept. With the precision Q of all that tells of the shape, pictures and what was
    known, the response e that keeps what is held and the free directions B, it is
    e - B (BᵀQB)⁻¹ BᵀQ e.
    """
    held, shapes = space.height_response, space.directions
    return held - shapes @ np.linalg.solve(
        shapes.T @ information @ shapes, shapes.T @ information @ held
    )
