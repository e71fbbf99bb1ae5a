"""Compiled LDLᵀ of a symmetric matrix with two unknowns a vertex, whose pattern is a mesh's graph.

Rows and columns are vertices in their order of elimination. An entry between two vertices is
diagonal, for albedo meets albedo and specularity specularity alone; a vertex's own is a full 2 x 2
block, and so is every entry of the factor. Blocks are rows of four numbers.
"""

from typing import no_type_check

import numpy as np
from numba import njit


@no_type_check
@njit(cache=True, nogil=True)
def factor_pattern(pointers, lower):
    """The elimination tree, -1 at its roots, and where each column of the factor begins.

    ``lower`` holds each vertex's neighbours that are eliminated before it, from ``pointers`` on.
    """
    count = pointers.size - 1
    parents = np.full(count, -1, dtype=np.int64)
    sizes = np.zeros(count, dtype=np.int64)
    reached = np.full(count, -1, dtype=np.int64)
    for row in range(count):
        reached[row] = row
        for place in range(pointers[row], pointers[row + 1]):
            column = lower[place]
            while reached[column] != row:
                if parents[column] < 0:
                    parents[column] = row
                sizes[column] += 1
                reached[column] = row
                column = parents[column]
    starts = np.zeros(count + 1, dtype=np.int64)
    for column in range(count):
        starts[column + 1] = starts[column] + sizes[column]
    return parents, starts


@no_type_check
@njit(cache=True, nogil=True, error_model="numpy")
def factorise(pointers, lower, between, own, parents, starts, rows, blocks, inverses):
    """Row by row: ``rows`` and ``blocks`` (r, 4) of L by column, and ``inverses`` (m, 4) of D.

    ``between`` (e, 2) are the entries of ``lower``, ``own`` (m, 3) each vertex's 2 x 2 block as its
    upper triangle.
    """
    count = pointers.size - 1
    ends = starts[:-1].copy()
    reached = np.full(count, -1, dtype=np.int64)
    pattern = np.empty(count, dtype=np.int64)
    path = np.empty(count, dtype=np.int64)
    work = np.zeros((count, 4))
    for row in range(count):
        reached[row] = row
        first = count
        for place in range(pointers[row], pointers[row + 1]):
            column = lower[place]
            work[column, 0] = between[place, 0]
            work[column, 3] = between[place, 1]
            length = 0
            while reached[column] != row:
                path[length] = column
                length += 1
                reached[column] = row
                column = parents[column]
            # Up the tree, so that a column comes before those it changes.
            for step in range(length - 1, -1, -1):
                first -= 1
                pattern[first] = path[step]
        a, b, d = own[row, 0], own[row, 1], own[row, 2]
        for index in range(first, count):
            column = pattern[index]
            z0, z1, z2, z3 = work[column]
            work[column] = 0.0
            for place in range(starts[column], ends[column]):
                target = rows[place]
                l0, l1, l2, l3 = blocks[place]
                work[target, 0] -= z0 * l0 + z1 * l1
                work[target, 1] -= z0 * l2 + z1 * l3
                work[target, 2] -= z2 * l0 + z3 * l1
                work[target, 3] -= z2 * l2 + z3 * l3
            i0, i1, i2, i3 = inverses[column]
            l0, l1 = z0 * i0 + z1 * i2, z0 * i1 + z1 * i3
            l2, l3 = z2 * i0 + z3 * i2, z2 * i1 + z3 * i3
            a -= l0 * z0 + l1 * z1
            b -= l0 * z2 + l1 * z3
            d -= l2 * z2 + l3 * z3
            place = ends[column]
            rows[place] = row
            blocks[place, 0] = l0
            blocks[place, 1] = l1
            blocks[place, 2] = l2
            blocks[place, 3] = l3
            ends[column] += 1
        scale = 1.0 / (a * d - b * b)
        inverses[row, 0] = d * scale
        inverses[row, 1] = -b * scale
        inverses[row, 2] = -b * scale
        inverses[row, 3] = a * scale


@no_type_check
@njit(cache=True, nogil=True)
def solve_factorised(starts, rows, blocks, inverses, right):
    """L D Lᵀ x = ``right`` (m, 2, c), in place, for c right-hand sides."""
    count = starts.size - 1
    for column in range(count):
        for place in range(starts[column], starts[column + 1]):
            row = rows[place]
            for c in range(right.shape[2]):
                x, y = right[column, 0, c], right[column, 1, c]
                right[row, 0, c] -= blocks[place, 0] * x + blocks[place, 1] * y
                right[row, 1, c] -= blocks[place, 2] * x + blocks[place, 3] * y
    for column in range(count - 1, -1, -1):
        for c in range(right.shape[2]):
            x, y = right[column, 0, c], right[column, 1, c]
            u = inverses[column, 0] * x + inverses[column, 1] * y
            v = inverses[column, 2] * x + inverses[column, 3] * y
            for place in range(starts[column], starts[column + 1]):
                row = rows[place]
                u -= blocks[place, 0] * right[row, 0, c] + blocks[place, 2] * right[row, 1, c]
                v -= blocks[place, 1] * right[row, 0, c] + blocks[place, 3] * right[row, 1, c]
            right[column, 0, c] = u
            right[column, 1, c] = v
