"""Compiled loops over triangles; the wrappers in :mod:`fitter.numerics.meshes` carry the shapes."""

from typing import no_type_check

import numpy as np
from numba import njit


@no_type_check
@njit(cache=True)
def sum_of_tetrahedra(vertices, triangles):
    """Signed volume of the tetrahedra between each triangle and the first vertex."""
    ox, oy, oz = vertices[0]
    total = 0.0
    for t in range(triangles.shape[0]):
        a, b, c = triangles[t]
        ax, ay, az = vertices[a, 0] - ox, vertices[a, 1] - oy, vertices[a, 2] - oz
        bx, by, bz = vertices[b, 0] - ox, vertices[b, 1] - oy, vertices[b, 2] - oz
        cx, cy, cz = vertices[c, 0] - ox, vertices[c, 1] - oy, vertices[c, 2] - oz
        total += ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
    return total / 6.0


@no_type_check
@njit(cache=True)
def tetrahedra_gradient(vertices, triangles):
    """By each vertex: a sixth of the cross products of the edges opposite to it."""
    gradient = np.zeros((vertices.shape[0], 3))
    for t in range(triangles.shape[0]):
        for corner in range(3):
            v = triangles[t, corner]
            a = triangles[t, (corner + 1) % 3]
            b = triangles[t, (corner + 2) % 3]
            for axis in range(3):
                i, j = (axis + 1) % 3, (axis + 2) % 3
                gradient[v, axis] += (
                    vertices[a, i] * vertices[b, j] - vertices[a, j] * vertices[b, i]
                ) / 6.0
    return gradient
