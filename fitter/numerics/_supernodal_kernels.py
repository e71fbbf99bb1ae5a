"""Numba kernels of the supernodal solve; see :mod:`fitter.numerics.supernodal`."""

from typing import no_type_check

import numpy as np
from numba import njit, uint32


@no_type_check
@njit(cache=True, fastmath=True, error_model="numpy")
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
    """Forward through L, then backward through D Lᵀ; three columns at once.

    Unsigned indices spare numba's test for negative ones: with them it takes 0.67 ms on a body
    instead of 0.83.
    """
    count = len(permutation)
    blocks = len(starts) - 1
    work = np.empty((count, 3))
    for i in range(count):
        p = uint32(permutation[i])
        for c in range(3):
            work[i, c] = right[p, c]
    for s in range(blocks):
        start = uint32(starts[s])
        width = uint32(starts[s + 1]) - start
        entry = uint32(triangle_pointers[s])
        for i in range(width):
            y0, y1, y2 = work[start + i, 0], work[start + i, 1], work[start + i, 2]
            for k in range(i):
                v = triangles[entry + k]
                y0 -= v * work[start + k, 0]
                y1 -= v * work[start + k, 1]
                y2 -= v * work[start + k, 2]
            work[start + i, 0], work[start + i, 1], work[start + i, 2] = y0, y1, y2
            entry += width
        entry = uint32(rectangle_pointers[s])
        for i in range(uint32(row_pointers[s]), uint32(row_pointers[s + 1])):
            r = uint32(rows[i])
            y0, y1, y2 = work[r, 0], work[r, 1], work[r, 2]
            for k in range(width):
                v = rectangles[entry + k]
                y0 -= v * work[start + k, 0]
                y1 -= v * work[start + k, 1]
                y2 -= v * work[start + k, 2]
            work[r, 0], work[r, 1], work[r, 2] = y0, y1, y2
            entry += width
    for back in range(blocks):
        s = blocks - 1 - back
        start = uint32(starts[s])
        width = uint32(starts[s + 1]) - start
        for k in range(width):
            for c in range(3):
                work[start + k, c] *= inverse_diagonal[start + k]
        entry = uint32(rectangle_pointers[s])
        for i in range(uint32(row_pointers[s]), uint32(row_pointers[s + 1])):
            r = uint32(rows[i])
            y0, y1, y2 = work[r, 0], work[r, 1], work[r, 2]
            for k in range(width):
                v = rectangles[entry + k]
                work[start + k, 0] -= v * y0
                work[start + k, 1] -= v * y1
                work[start + k, 2] -= v * y2
            entry += width
        for up in range(width):
            i = width - uint32(1) - up
            y0, y1, y2 = work[start + i, 0], work[start + i, 1], work[start + i, 2]
            entry = uint32(triangle_pointers[s]) + i * width
            for k in range(i):
                v = triangles[entry + k]
                work[start + k, 0] -= v * y0
                work[start + k, 1] -= v * y1
                work[start + k, 2] -= v * y2
    for i in range(count):
        p = uint32(permutation[i])
        for c in range(3):
            result[p, c] = work[i, c]


@no_type_check
@njit(cache=True)
def fill_blocks(
    pointers,
    indices,
    values,
    starts,
    row_pointers,
    rows,
    triangle_pointers,
    triangles,
    rectangle_pointers,
    rectangles,
):
    """Entries of a strictly lower triangular matrix (CSC, sorted) to their places in the blocks."""
    for block in range(len(starts) - 1):
        start, stop = starts[block], starts[block + 1]
        width = stop - start
        for column in range(start, stop):
            place = row_pointers[block]
            for entry in range(pointers[column], pointers[column + 1]):
                row = indices[entry]
                if row < stop:
                    inside = (row - start) * width + column - start
                    triangles[triangle_pointers[block] + inside] = values[entry]
                    continue
                while rows[place] != row:
                    place += 1
                below = (place - row_pointers[block]) * width + column - start
                rectangles[rectangle_pointers[block] + below] = values[entry]
