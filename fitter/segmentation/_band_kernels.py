"""Compiled loops of the band's graph. Plain arrays in and out; the wrappers document them."""

from typing import no_type_check

import numpy as np
from numba import njit

OUTSIDE = -1
"""Node number of a pixel outside the picture."""


@no_type_check
@njit(cache=True, nogil=True)
def mean_squared_difference(picture):
    """Mean of |z_p - z_q|² over all pairs of 8-neighbours, in squared steps of 8-bit values."""
    height, width = picture.shape[:2]
    total = 0
    for i in range(height):
        row = 0
        for j in range(width):
            for c in range(3):
                here = np.int32(picture[i, j, c])
                if j + 1 < width:
                    difference = here - np.int32(picture[i, j + 1, c])
                    row += difference * difference
                if i + 1 < height:
                    difference = here - np.int32(picture[i + 1, j, c])
                    row += difference * difference
                    if j + 1 < width:
                        difference = here - np.int32(picture[i + 1, j + 1, c])
                        row += difference * difference
                    if j > 0:
                        difference = here - np.int32(picture[i + 1, j - 1, c])
                        row += difference * difference
        total += row
    pairs = height * (width - 1) + (height - 1) * width + 2 * (height - 1) * (width - 1)
    return total / max(pairs, 1)


@no_type_check
@njit(cache=True, nogil=True)
def link_band(picture, known_foreground, nodes, rows, columns, straight, diagonal):
    """Arcs between the band's pixels, and their links to known neighbours.

    ``nodes`` (h, w) numbers the open pixels and is negative at known ones; ``straight`` and
    ``diagonal`` hold an arc's capacity by the squared difference of its two pixels, and end where
    it rounds to zero. Returns the (8 n,) heads and capacities and the (n,) links to known
    foreground minus those to known background.
    """
    height, width = nodes.shape
    count = rows.shape[0]
    heads = np.full(8 * count, OUTSIDE, dtype=np.int32)
    capacities = np.zeros(8 * count, dtype=np.int32)
    bound = np.zeros(count, dtype=np.int32)
    for node in range(count):
        i, j = rows[node], columns[node]
        for direction in range(8):
            place = direction if direction < 4 else direction + 1
            ni, nj = i + place // 3 - 1, j + place % 3 - 1
            if not (0 <= ni < height and 0 <= nj < width):
                continue
            other = nodes[ni, nj]
            if 0 <= other < node:
                continue  # Already written from the other side.
            squared = 0
            for c in range(3):
                difference = np.int32(picture[i, j, c]) - np.int32(picture[ni, nj, c])
                squared += difference * difference
            table = straight if i == ni or j == nj else diagonal
            capacity = table[squared] if squared < table.shape[0] else 0
            if other >= 0:
                heads[8 * node + direction] = other
                heads[8 * other + 7 - direction] = node
                capacities[8 * node + direction] = capacity
                capacities[8 * other + 7 - direction] = capacity
            elif known_foreground[ni, nj]:
                bound[node] += capacity
            else:
                bound[node] -= capacity
    return heads, capacities, bound
