"""Compiled loops over triangles; the wrappers in :mod:`fitter.numerics.meshes` carry the shapes."""

from math import sqrt
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


@no_type_check
@njit(cache=True, fastmath=True)
def accumulate_normals(vertices, triangles, result):
    """Sum of the cross products of the triangles round each vertex (twice area times normal)."""
    result[:] = 0.0
    for t in range(len(triangles)):
        a, b, c = triangles[t]
        ux = vertices[b, 0] - vertices[a, 0]
        uy = vertices[b, 1] - vertices[a, 1]
        uz = vertices[b, 2] - vertices[a, 2]
        vx = vertices[c, 0] - vertices[a, 0]
        vy = vertices[c, 1] - vertices[a, 1]
        vz = vertices[c, 2] - vertices[a, 2]
        x = uy * vz - uz * vy
        y = uz * vx - ux * vz
        z = ux * vy - uy * vx
        for corner in (a, b, c):
            result[corner, 0] += x
            result[corner, 1] += y
            result[corner, 2] += z


@no_type_check
@njit(cache=True, fastmath=True)
def pull_back_normals(vertices, triangles, pointers, rings, chosen, by_normal, result):
    """Add the derivative by vertices of a scalar known by its derivative by some unit normals.

    With S = Σ u × v over a vertex' ring, a derivative g by the unit normal n = S / |S| is
    q = (g - (g . n) n) / |S| by S, and of every cross product v × q by u and q × u by v.
    """
    for i in range(len(chosen)):
        vertex = chosen[i]
        sx = sy = sz = 0.0
        for r in range(pointers[vertex], pointers[vertex + 1]):
            t = rings[r]
            a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
            ux, uy, uz = (
                vertices[b, 0] - vertices[a, 0],
                vertices[b, 1] - vertices[a, 1],
                vertices[b, 2] - vertices[a, 2],
            )
            vx, vy, vz = (
                vertices[c, 0] - vertices[a, 0],
                vertices[c, 1] - vertices[a, 1],
                vertices[c, 2] - vertices[a, 2],
            )
            sx += uy * vz - uz * vy
            sy += uz * vx - ux * vz
            sz += ux * vy - uy * vx
        length = sqrt(sx * sx + sy * sy + sz * sz)
        if length == 0.0:
            continue
        sx, sy, sz = sx / length, sy / length, sz / length
        gx, gy, gz = by_normal[i, 0], by_normal[i, 1], by_normal[i, 2]
        along = gx * sx + gy * sy + gz * sz
        qx, qy, qz = (
            (gx - along * sx) / length,
            (gy - along * sy) / length,
            (gz - along * sz) / length,
        )
        for r in range(pointers[vertex], pointers[vertex + 1]):
            t = rings[r]
            a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
            # By u = b - a and v = c - a; a takes what both leave, q × (c - b).
            ux, uy, uz = (
                vertices[b, 0] - vertices[a, 0],
                vertices[b, 1] - vertices[a, 1],
                vertices[b, 2] - vertices[a, 2],
            )
            vx, vy, vz = (
                vertices[c, 0] - vertices[a, 0],
                vertices[c, 1] - vertices[a, 1],
                vertices[c, 2] - vertices[a, 2],
            )
            bx, by, bz = vy * qz - vz * qy, vz * qx - vx * qz, vx * qy - vy * qx
            cx, cy, cz = qy * uz - qz * uy, qz * ux - qx * uz, qx * uy - qy * ux
            result[b, 0] += bx
            result[b, 1] += by
            result[b, 2] += bz
            result[c, 0] += cx
            result[c, 1] += cy
            result[c, 2] += cz
            result[a, 0] -= bx + cx
            result[a, 1] -= by + cy
            result[a, 2] -= bz + cz
