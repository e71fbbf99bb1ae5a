"""How certain shape and tilt are: the Laplace approximation at the final body."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import Shape
from fitter.energies.attributes import attribute_slopes
from fitter.energies.objective import Candidate, Objective
from fitter.energies.priors import height_extrapolation
from fitter.optimizer.free_space import FreeSpace, free_space, kept_directions
from fitter.optimizer.light_freedom import information_lost_to_light
from fitter.optimizer.normal_equations import normal_equations
from fitter.optimizer.tilt_freedom import tilt_covariance
from fitter.parameters import CameraTilt, StanceKind


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Certainty:
    """The covariance of all body parameters at a minimum, with light and ease marginalised.

    Attributes
    ----------
    objective, candidate
        Whose minimum.
    space
        The steps that keep what is held.
    covariance
        Of all parameters within that space, (columns, columns).
    """

    objective: Objective
    candidate: Candidate
    space: FreeSpace
    covariance: Float[np.ndarray, "columns columns"]


def certainty(objective: Objective, candidate: Candidate) -> Certainty:
    """How certain the body is.

    The albedo of each vertex is held, as is everything else the objective fixes. Energies are
    negative log-likelihoods, so the inverse of the Gauss-Newton matrix is the covariance of all
    parameters near the minimum. What is held exactly does not vary.
    """
    matrix = body_information(objective, candidate)
    space = free_space(objective.attributes.held, candidate.parameters)
    inner = space.directions.T @ matrix @ space.directions
    inverse = np.linalg.inv(inner + 1e-9 * np.eye(len(inner)))
    return Certainty(
        objective=objective,
        candidate=candidate,
        space=space,
        covariance=space.directions @ inverse @ space.directions.T,
    )


def body_information(
    objective: Objective, candidate: Candidate
) -> Float[np.ndarray, "columns columns"]:
    """The Gauss-Newton matrix of all body parameters, with light and ease marginalised."""
    matrix, _ = normal_equations(objective, candidate, marginal=True)
    if objective.evidence.shading is not None:
        matrix -= information_lost_to_light(objective, candidate, objective.evidence.shading)
    return matrix


def shape_covariance(certain: Certainty, *, height_variance: float) -> Float[np.ndarray, "n n"]:
    """Covariance of the shape, with pose and position marginalised.

    The height is never estimated from the picture: ``height_variance`` is the population's, given
    what is known, in its coefficient's unit; zero for a height that is known. Beyond usual heights
    all is wider (:func:`fitter.energies.priors.height_extrapolation`).
    """
    shape = certain.candidate.parameters.shape
    n = len(shape)
    response = _height_response(certain.objective, certain.candidate, certain.space)
    covariance = certain.covariance[-n:, -n:] + height_variance * np.outer(response, response)
    return height_extrapolation(float(shape[0])) * covariance


def camera_tilt(certain: Certainty) -> CameraTilt:
    """The camera's tilt, as the body tells it, with its covariance."""
    candidate = certain.candidate
    tilt = candidate.tilt
    return CameraTilt(
        pitch=tilt.pitch,
        roll=tilt.roll,
        covariance=tilt_covariance(certain.objective.operators, candidate, certain.covariance),
        stances=dict(zip(StanceKind, tilt.shares.tolist(), strict=True)),
    )


def _height_response(objective: Objective, candidate: Candidate, space: FreeSpace) -> Shape:
    """How the most probable shape changes with the height coefficient.

    What is held is kept. With Q = P + SᵀS, from the prior's precision and the slopes of the
    uncertain attributes, the response e that keeps what is held and the free directions B, it is
    e - B (BᵀQB)⁻¹ BᵀQ e.
    """
    held, shape = space.height_response, candidate.parameters.shape
    shapes = kept_directions(objective.attributes.held, shape)
    slopes = attribute_slopes(objective.attributes, shape)
    known = objective.shape_prior.precision + slopes.T @ slopes
    return held - shapes @ np.linalg.solve(shapes.T @ known @ shapes, shapes.T @ known @ held)
