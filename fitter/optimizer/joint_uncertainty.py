"""How certain one shape in several pictures is, and the bodies that have it."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from fitter.energies.attributes import attribute_slopes
from fitter.energies.joint_objective import JointObjective
from fitter.energies.objective import Candidate
from fitter.optimizer.free_space import free_space, kept_directions
from fitter.optimizer.uncertainty import Certainty, body_information


def joint_certainty(
    objective: JointObjective, candidates: Sequence[Candidate]
) -> tuple[Certainty, ...]:
    """How certain each picture's body is, given all pictures.

    The information about the shape is what every picture says of it once its own pose and place
    are eliminated, weighted, and what was known; the shape's covariance is its inverse Σ. With a
    picture's own blocks A and B of :mod:`fitter.optimizer.joint_equations`, the covariance of its
    pose and place is A⁻¹ + G Σ Gᵀ and that with the shape G Σ, where G = -A⁻¹ B.
    """
    shape = candidates[0].parameters.shape
    n = len(shape)
    directions = kept_directions(objective.attributes.held, shape)
    slopes = attribute_slopes(objective.attributes, shape)
    matrix = directions.T @ (objective.shape_prior.precision + slopes.T @ slopes) @ directions
    inverses: list[Float[np.ndarray, "own own"]] = []
    responses: list[Float[np.ndarray, "own free"]] = []
    for view, candidate in zip(objective.views, candidates, strict=True):
        own = objective.weight * body_information(view, candidate)
        inverse = np.linalg.inv(own[:-n, :-n])
        border = own[:-n, -n:] @ directions
        matrix = matrix + directions.T @ own[-n:, -n:] @ directions - border.T @ inverse @ border
        inverses.append(inverse)
        responses.append(-inverse @ border)
    free = np.linalg.inv(matrix)
    certain: list[Certainty] = []
    for view, candidate, inverse, response in zip(
        objective.views, candidates, inverses, responses, strict=True
    ):
        spread = np.concatenate([response, directions])
        covariance = spread @ free @ spread.T
        covariance[:-n, :-n] += inverse
        certain.append(
            Certainty(
                objective=objective.with_knowledge(view),
                candidate=candidate,
                space=free_space(objective.attributes.held, candidate.parameters),
                covariance=covariance,
            )
        )
    return tuple(certain)
