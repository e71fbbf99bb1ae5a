"""Numba kernel of rotation matrices; see :mod:`fitter.numerics.rotations`."""

from math import cos, sin, sqrt
from typing import no_type_check

from numba import njit


@no_type_check
@njit(cache=True)
def rodrigues(vectors, small_angle, result):
    """I + s K + c K² for each vector, with K² = v vᵀ - t² I written out."""
    for k in range(len(vectors)):
        x, y, z = vectors[k, 0], vectors[k, 1], vectors[k, 2]
        squared = x * x + y * y + z * z
        angle = sqrt(squared)
        if angle < small_angle:
            s = 1.0 - squared / 6.0
            c = 0.5 - squared / 24.0
        else:
            s = sin(angle) / angle
            c = (1.0 - cos(angle)) / squared
        result[k, 0, 0] = 1.0 - c * (y * y + z * z)
        result[k, 1, 1] = 1.0 - c * (x * x + z * z)
        result[k, 2, 2] = 1.0 - c * (x * x + y * y)
        result[k, 0, 1] = c * x * y - s * z
        result[k, 1, 0] = c * x * y + s * z
        result[k, 0, 2] = c * x * z + s * y
        result[k, 2, 0] = c * x * z - s * y
        result[k, 1, 2] = c * y * z - s * x
        result[k, 2, 1] = c * y * z + s * x
