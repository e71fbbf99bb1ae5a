"""Numba kernels that find where a mesh runs through itself."""

from typing import no_type_check

import numpy as np
from numba import njit


@no_type_check
@njit(cache=True)
def cell_range(low, high, origin, cell, counts):
    """First and last grid cell of a box along each axis, clipped to the grid."""
    first = np.empty(3, np.int64)
    last = np.empty(3, np.int64)
    for axis in range(3):
        first[axis] = min(max(int((low[axis] - origin[axis]) / cell), 0), counts[axis] - 1)
        last[axis] = min(max(int((high[axis] - origin[axis]) / cell), 0), counts[axis] - 1)
    return first, last


@no_type_check
@njit(cache=True)
def grid_of_triangles(vertices, triangles, origin, cell, counts):
    """Triangles whose boxes touch each cell (CSR): two passes, first counting, then filling."""
    total = counts[0] * counts[1] * counts[2]
    pointers = np.zeros(total + 1, np.int64)
    members = np.empty(0, np.int32)
    for filling in range(2):
        if filling:
            for index in range(total, 0, -1):
                pointers[index] = pointers[index - 1]
            pointers[0] = 0
            for index in range(total):
                pointers[index + 1] += pointers[index]
            members = np.empty(pointers[total], np.int32)
            place = pointers.copy()
        for t in range(len(triangles)):
            low = np.minimum(
                np.minimum(vertices[triangles[t, 0]], vertices[triangles[t, 1]]),
                vertices[triangles[t, 2]],
            )
            high = np.maximum(
                np.maximum(vertices[triangles[t, 0]], vertices[triangles[t, 1]]),
                vertices[triangles[t, 2]],
            )
            first, last = cell_range(low, high, origin, cell, counts)
            for i in range(first[0], last[0] + 1):
                for j in range(first[1], last[1] + 1):
                    for k in range(first[2], last[2] + 1):
                        index = (i * counts[1] + j) * counts[2] + k
                        if filling:
                            members[place[index]] = t
                            place[index] += 1
                        else:
                            pointers[index] += 1
    return pointers, members


@no_type_check
@njit(cache=True)
def signed_volume(a, b, c, d):
    """Six times the volume of a tetrahedron."""
    ux, uy, uz = a[0] - d[0], a[1] - d[1], a[2] - d[2]
    vx, vy, vz = b[0] - d[0], b[1] - d[1], b[2] - d[2]
    wx, wy, wz = c[0] - d[0], c[1] - d[1], c[2] - d[2]
    return ux * (vy * wz - vz * wy) + uy * (vz * wx - vx * wz) + uz * (vx * wy - vy * wx)


@no_type_check
@njit(cache=True)
def pierces(p, q, a, b, c):
    """Whether the open segment from p to q runs through the inside of a triangle."""
    if signed_volume(a, b, c, p) * signed_volume(a, b, c, q) >= 0.0:
        return False
    first = signed_volume(p, q, a, b)
    second = signed_volume(p, q, b, c)
    third = signed_volume(p, q, c, a)
    return (first > 0.0 and second > 0.0 and third > 0.0) or (
        first < 0.0 and second < 0.0 and third < 0.0
    )


@no_type_check
@njit(cache=True)
def apart(vertices, a, b, c, low, high):
    """Whether a triangle's box and another do not touch."""
    for axis in range(3):
        x, y, z = vertices[a, axis], vertices[b, axis], vertices[c, axis]
        if min(x, y, z) > high[axis] or max(x, y, z) < low[axis]:
            return True
    return False


@no_type_check
@njit(cache=True)
def mark_pierced(vertices, triangles, edges, pointers, members, origin, cell, counts, pierced):
    """Mark the triangles that an edge, which shares no corner with them, runs through."""
    for e in range(len(edges)):
        start, end = edges[e]
        p, q = vertices[start], vertices[end]
        low, high = np.minimum(p, q), np.maximum(p, q)
        first, last = cell_range(low, high, origin, cell, counts)
        for i in range(first[0], last[0] + 1):
            for j in range(first[1], last[1] + 1):
                for k in range(first[2], last[2] + 1):
                    index = (i * counts[1] + j) * counts[2] + k
                    for m in range(pointers[index], pointers[index + 1]):
                        t = members[m]
                        a, b, c = triangles[t]
                        if pierced[t] or start in (a, b, c) or end in (a, b, c):
                            continue
                        if apart(vertices, a, b, c, low, high):
                            continue
                        if pierces(p, q, vertices[a], vertices[b], vertices[c]):
                            pierced[t] = True
