"""Numba kernels for vertex normals and their derivatives."""

from typing import no_type_check

import numpy as np
from numba import njit


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
def pull_back_normals(vertices, triangles, pull, result):
    """Derivative by vertices of a scalar whose derivative by summed cross products is ``pull``."""
    result[:] = 0.0
    u = np.empty(3)
    v = np.empty(3)
    s = np.empty(3)
    for t in range(len(triangles)):
        a, b, c = triangles[t]
        for k in range(3):
            u[k] = vertices[b, k] - vertices[a, k]
            v[k] = vertices[c, k] - vertices[a, k]
            s[k] = pull[a, k] + pull[b, k] + pull[c, k]
        if s[0] == 0.0 and s[1] == 0.0 and s[2] == 0.0:
            continue
        for k in range(3):
            k1 = (k + 1) % 3
            k2 = (k + 2) % 3
            by_u = v[k1] * s[k2] - v[k2] * s[k1]
            by_v = s[k1] * u[k2] - s[k2] * u[k1]
            result[b, k] += by_u
            result[c, k] += by_v
            result[a, k] -= by_u + by_v


@no_type_check
@njit(cache=True, fastmath=True)
def change_of_normals(vertices, triangles, pointers, rings, chosen, moves, result):
    """Change of the summed cross products at chosen vertices for n fields of motion."""
    n = moves.shape[0]
    result[:] = 0.0
    u = np.empty(3)
    v = np.empty(3)
    for i in range(len(chosen)):
        vertex = chosen[i]
        for r in range(pointers[vertex], pointers[vertex + 1]):
            a, b, c = triangles[rings[r]]
            for k in range(3):
                u[k] = vertices[b, k] - vertices[a, k]
                v[k] = vertices[c, k] - vertices[a, k]
            for j in range(n):
                for k in range(3):
                    k1 = (k + 1) % 3
                    k2 = (k + 2) % 3
                    du1 = moves[j, b, k1] - moves[j, a, k1]
                    du2 = moves[j, b, k2] - moves[j, a, k2]
                    dv1 = moves[j, c, k1] - moves[j, a, k1]
                    dv2 = moves[j, c, k2] - moves[j, a, k2]
                    result[i, j, k] += du1 * v[k2] - du2 * v[k1] + u[k1] * dv2 - u[k2] * dv1
