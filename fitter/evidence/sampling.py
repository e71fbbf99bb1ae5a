"""Bilinear sampling of a map at continuous pixels, with its slope."""

import numpy as np
from jaxtyping import Float

from fitter.arrays import GreyImage, Points2D
from fitter.evidence._sampling_kernels import bilinear


def sample(values: GreyImage, points: Points2D) -> tuple[Float[np.ndarray, " k"], Points2D]:
    """Values and derivatives (per pixel, x then y) of the bilinear interpolation.

    Pixel centres lie at + 0.5; beyond the outermost centres the map continues unchanged and its
    slope across the border is zero.
    """
    result = np.empty((len(points), 3))
    bilinear(values, np.ascontiguousarray(points, dtype=np.float64), result)
    return result[:, 0], result[:, 1:]
