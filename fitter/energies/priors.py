"""Priors on the whole body: the population of section 4 is N(0, I), and people stand upright."""

import numpy as np
from jaxtyping import Float

from fitter.arrays import Pose, Shape
from fitter.numerics.rotations import rotation_matrices

LEAN_SPREAD = 0.2
"""Sine of the angle by which the pelvis leans out of the picture's plane, one standard deviation.
Leaning toward or away from the camera hardly changes an outline, so an outline with a fault will
use it: without this prior a body leans 40 degrees back to cover some ground with its feet. Lying
people are seen lying by their clicks, which shorten their limbs by far more than this resists."""


def shape_prior_energy(shape: Shape) -> float:
    """½ |β|² without the height coefficient, which is known and not estimated."""
    return 0.5 * float(shape[1:] @ shape[1:])


def shape_prior_precision(count: int) -> Float[np.ndarray, " n"]:
    """Diagonal of the prior's information matrix."""
    precision = np.ones(count)
    precision[0] = 0.0
    return precision


def lean_residual(pose: Pose) -> tuple[float, Float[np.ndarray, "3"]]:
    """Depth component of the pelvis' upward axis over its spread, and its derivative.

    The derivative is by the root's increment δ: d(R e_y) = δ × R e_y.
    """
    up = rotation_matrices(pose[:1])[0, :, 1]
    return float(up[2]) / LEAN_SPREAD, np.array([up[1], -up[0], 0.0]) / LEAN_SPREAD
