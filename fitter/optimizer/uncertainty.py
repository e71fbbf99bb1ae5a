"""How certain the shape is: the Laplace approximation at the final body."""

import numpy as np
from jaxtyping import Float

from fitter.energies.objective import Candidate, Objective
from fitter.optimizer.free_space import free_space
from fitter.optimizer.normal_equations import normal_equations


def shape_covariance(
    objective: Objective, candidate: Candidate, *, height_variance: float
) -> Float[np.ndarray, "n n"]:
    """Covariance of the shape with pose and place marginalised.

    Light and reflectance are held, as is everything else the objective fixes. Energies are negative
    log-likelihoods, so the inverse of the Gauss-Newton matrix is the covariance of all parameters
    near the minimum. What is held exactly does not vary. The height is never estimated from the
    picture: ``height_variance`` is the population's, given what is known, in its coefficient's
    unit; zero for a height that is known.
    """
    matrix, _ = normal_equations(objective, candidate)
    space = free_space(objective.attributes.held, candidate.parameters)
    inner = space.directions.T @ matrix @ space.directions
    inverse = np.linalg.inv(inner + 1e-9 * np.eye(len(inner)))
    shapes = space.directions[-len(candidate.parameters.shape) :]
    return shapes @ inverse @ shapes.T + height_variance * np.outer(
        space.height_response, space.height_response
    )
