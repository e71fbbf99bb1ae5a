"""How certain the shape is: the Laplace approximation at the final body."""

import numpy as np
from jaxtyping import Float

from fitter.energies.objective import Candidate, Objective
from fitter.optimizer.normal_equations import normal_equations
from fitter.optimizer.parameter_vector import free_columns


def shape_covariance(
    objective: Objective, candidate: Candidate, *, height_known: bool
) -> Float[np.ndarray, "n n"]:
    """Covariance of the shape with pose and place marginalised; zero for the held height.

    Light and reflectance are held, as is everything else the objective fixes. Energies are negative
    log-likelihoods, so the inverse of the Gauss-Newton matrix is the covariance of all parameters
    near the minimum.
    """
    matrix, _ = normal_equations(objective, candidate)
    free = free_columns(candidate.parameters)
    inverse = np.linalg.inv(matrix[np.ix_(free, free)] + 1e-9 * np.eye(int(free.sum())))
    count = len(candidate.parameters.shape)
    covariance = np.zeros((count, count))
    # An assumed height is as uncertain as the population's: one standard deviation by definition.
    covariance[0, 0] = 0.0 if height_known else 1.0
    covariance[1:, 1:] = inverse[-(count - 1) :, -(count - 1) :]
    return covariance
