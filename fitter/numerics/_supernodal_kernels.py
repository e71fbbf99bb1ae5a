"""Numba kernel of the supernodal solve; see :mod:`fitter.numerics.supernodal`."""

from typing import no_type_check

import numpy as np
from numba import njit


@no_type_check
@njit(cache=True, fastmath=True)
def solve_supernodal(
    starts,
    row_pointers,
    rows,
    triangle_pointers,
    triangles,
    rectangle_pointers,
    rectangles,
    inverse_diagonal,
    permutation,
    right,
    result,
):
    """Forward through L, then backward through D Lᵀ; three columns at once."""
    count = len(permutation)
    blocks = len(starts) - 1
    widest = 0
    for s in range(blocks):
        widest = max(widest, starts[s + 1] - starts[s])
    work = np.empty((count, 3))
    x = np.empty((3, widest))
    for i in range(count):
        for c in range(3):
            work[i, c] = right[permutation[i], c]
    for s in range(blocks):
        start = starts[s]
        width = starts[s + 1] - start
        entry = triangle_pointers[s]
        for i in range(width):
            y0, y1, y2 = work[start + i, 0], work[start + i, 1], work[start + i, 2]
            for k in range(i):
                v = triangles[entry + k]
                y0 -= v * x[0, k]
                y1 -= v * x[1, k]
                y2 -= v * x[2, k]
            x[0, i], x[1, i], x[2, i] = y0, y1, y2
            work[start + i, 0], work[start + i, 1], work[start + i, 2] = y0, y1, y2
            entry += width
        entry = rectangle_pointers[s]
        for i in range(row_pointers[s], row_pointers[s + 1]):
            y0 = y1 = y2 = 0.0
            for k in range(width):
                v = rectangles[entry + k]
                y0 += v * x[0, k]
                y1 += v * x[1, k]
                y2 += v * x[2, k]
            r = rows[i]
            work[r, 0] -= y0
            work[r, 1] -= y1
            work[r, 2] -= y2
            entry += width
    for s in range(blocks - 1, -1, -1):
        start = starts[s]
        width = starts[s + 1] - start
        for k in range(width):
            for c in range(3):
                x[c, k] = work[start + k, c] * inverse_diagonal[start + k]
        entry = rectangle_pointers[s]
        for i in range(row_pointers[s], row_pointers[s + 1]):
            r = rows[i]
            y0, y1, y2 = work[r, 0], work[r, 1], work[r, 2]
            for k in range(width):
                v = rectangles[entry + k]
                x[0, k] -= v * y0
                x[1, k] -= v * y1
                x[2, k] -= v * y2
            entry += width
        for i in range(width - 1, -1, -1):
            y0, y1, y2 = x[0, i], x[1, i], x[2, i]
            entry = triangle_pointers[s] + i * width
            for k in range(i):
                v = triangles[entry + k]
                x[0, k] -= v * y0
                x[1, k] -= v * y1
                x[2, k] -= v * y2
            work[start + i, 0], work[start + i, 1], work[start + i, 2] = y0, y1, y2
    for i in range(count):
        for c in range(3):
            result[permutation[i], c] = work[i, c]
