"""Points that stand for a Gaussian: of low discrepancy and always the same."""

import numpy as np
from jaxtyping import Float
from scipy.special import ndtri
from scipy.stats import qmc

_NO_VARIANCE = 1e-12
"""Of the largest variance: directions that vary less do not vary."""


def gaussian_points(
    mean: Float[np.ndarray, " k"], covariance: Float[np.ndarray, "k k"], *, power: int
) -> Float[np.ndarray, "n k"]:
    """2 ** ``power`` points of a Gaussian, each as probable as any other.

    A Sobol sequence, moved into the middle of its cells and taken through the normal quantiles,
    whose first axes go along the directions of largest variance. In one dimension the points are
    the quantiles of the middles of n equal shares.
    """
    variances, directions = np.linalg.eigh(covariance)
    varying = variances > _NO_VARIANCE * max(float(variances[-1]), 0.0)
    spread = directions[:, varying] * np.sqrt(variances[varying])
    count = 2**power
    if not varying.any():
        return np.tile(mean, (count, 1))
    uniform = qmc.Sobol(spread.shape[1], scramble=False).random_base2(power) + 0.5 / count
    return mean + ndtri(uniform) @ spread[:, ::-1].T
