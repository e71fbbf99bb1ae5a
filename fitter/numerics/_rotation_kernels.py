"""Numba kernels of rotations; see :mod:`fitter.numerics.rotations`."""

from math import atan2, cos, sin, sqrt
from typing import no_type_check

from numba import njit

SMALL_ANGLE = 1e-8
SERIES_BELOW = 1e-4
"""Radians below which 1/t² - (1 + cos t) / (2 t sin t) is its limit, 1/12."""


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


@no_type_check
@njit(cache=True, forceinline=True)
def unit_quaternion(vector, small_angle):
    """(w, x, y, z) of a rotation vector."""
    x, y, z = vector
    angle = sqrt(x * x + y * y + z * z)
    factor = 0.5 if angle < small_angle else sin(0.5 * angle) / angle
    return cos(0.5 * angle), factor * x, factor * y, factor * z


@no_type_check
@njit(cache=True)
def composed(first, second, small_angle, result):
    """log(exp(first) exp(second)) for each pair, by the product of unit quaternions."""
    for k in range(len(first)):
        aw, ax, ay, az = unit_quaternion(first[k], small_angle)
        bw, bx, by, bz = unit_quaternion(second[k], small_angle)
        w = aw * bw - ax * bx - ay * by - az * bz
        x = aw * bx + ax * bw + ay * bz - az * by
        y = aw * by - ax * bz + ay * bw + az * bx
        z = aw * bz + ax * by - ay * bx + az * bw
        if w < 0.0:
            w, x, y, z = -w, -x, -y, -z
        sine = sqrt(x * x + y * y + z * z)
        factor = 2.0 if sine < small_angle else 2.0 * atan2(sine, w) / sine
        result[k, 0], result[k, 1], result[k, 2] = factor * x, factor * y, factor * z


@no_type_check
@njit(cache=True)
def inverse_left_jacobians(vectors, series_below, result):
    """I - K/2 + f K² for each vector, with K² = v vᵀ - t² I written out."""
    for k in range(len(vectors)):
        x, y, z = vectors[k]
        squared = x * x + y * y + z * z
        half = 0.5 * sqrt(squared)
        if 2.0 * half < series_below:
            f = 1.0 / 12.0
        else:
            # (1 + cos t) / sin t = cot(t/2), written so that t = π is regular.
            f = (1.0 - half * cos(half) / sin(half)) / squared
        result[k, 0, 0] = 1.0 - f * (y * y + z * z)
        result[k, 1, 1] = 1.0 - f * (x * x + z * z)
        result[k, 2, 2] = 1.0 - f * (x * x + y * y)
        result[k, 0, 1], result[k, 1, 0] = f * x * y + 0.5 * z, f * x * y - 0.5 * z
        result[k, 0, 2], result[k, 2, 0] = f * x * z - 0.5 * y, f * x * z + 0.5 * y
        result[k, 1, 2], result[k, 2, 1] = f * y * z + 0.5 * x, f * y * z - 0.5 * x
