"""Priors on shape: the population of section 4 is N(0, I) in whitened coefficients."""

import numpy as np
from jaxtyping import Float

from fitter.arrays import Shape


def shape_prior_energy(shape: Shape) -> float:
    """½ |β|² without the height coefficient, which is known and not estimated."""
    return 0.5 * float(shape[1:] @ shape[1:])


def shape_prior_precision(count: int) -> Float[np.ndarray, " n"]:
    """Diagonal of the prior's information matrix."""
    precision = np.ones(count)
    precision[0] = 0.0
    return precision
