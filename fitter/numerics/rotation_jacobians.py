"""How a rotation vector moves when its rotation is turned a little further."""

import numpy as np
from jaxtyping import Float

from fitter.numerics.rotations import cross_product_matrices

_SMALL_ANGLE = 1e-4


def inverse_left_jacobians(
    vectors: Float[np.ndarray, "... 3"],
) -> Float[np.ndarray, "... 3 3"]:
    """Matrices B with log(exp(δ) exp(v)) = v + B δ + O(δ²).

    B = I - K/2 + (1/t² - (1 + cos t) / (2 t sin t)) K², with K the cross-product matrix of v and
    t its length; singular only at a full turn.
    """
    vectors = np.asarray(vectors, dtype=np.float64)
    flat = vectors.reshape(-1, 3)
    squared = np.einsum("ki,ki->k", flat, flat)
    small = squared < _SMALL_ANGLE * _SMALL_ANGLE
    safe = np.where(small, 1.0, squared)
    half = 0.5 * np.sqrt(safe)
    # (1 + cos t) / sin t = cot(t/2), written so that t = π is regular.
    factor = np.where(small, 1.0 / 12.0, (1.0 - half * np.cos(half) / np.sin(half)) / safe)
    cross = cross_product_matrices(flat)
    result = np.eye(3) - 0.5 * cross + factor[:, None, None] * np.matmul(cross, cross)
    return result.reshape(*vectors.shape, 3)
