"""Numba kernel of the sparse solve; see :mod:`fitter.numerics.sparse_factor`."""

from typing import no_type_check

import numpy as np
from numba import njit, uint32


@no_type_check
@njit(cache=True, fastmath=True, error_model="numpy")
def solve_factored(pointers, rows, values, inverse_diagonal, permutation, right, result):
    """Forward through L, then backward through D Lᵀ; three columns at once.

    Unsigned indices spare numba's test for negative ones.
    """
    count = len(permutation)
    work = np.empty((count, 3))
    for i in range(count):
        p = uint32(permutation[i])
        for c in range(3):
            work[i, c] = right[p, c]
    for j in range(count):
        x, y, z = work[j, 0], work[j, 1], work[j, 2]
        for entry in range(uint32(pointers[j]), uint32(pointers[j + 1])):
            r, v = uint32(rows[entry]), values[entry]
            work[r, 0] -= v * x
            work[r, 1] -= v * y
            work[r, 2] -= v * z
    for back in range(count):
        j = count - 1 - back
        scale = inverse_diagonal[j]
        x, y, z = work[j, 0] * scale, work[j, 1] * scale, work[j, 2] * scale
        for entry in range(uint32(pointers[j]), uint32(pointers[j + 1])):
            r, v = uint32(rows[entry]), values[entry]
            x -= v * work[r, 0]
            y -= v * work[r, 1]
            z -= v * work[r, 2]
        work[j, 0], work[j, 1], work[j, 2] = x, y, z
    for i in range(count):
        p = uint32(permutation[i])
        for c in range(3):
            result[p, c] = work[i, c]
