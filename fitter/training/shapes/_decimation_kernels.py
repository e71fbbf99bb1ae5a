"""Numba kernel of mesh decimation; see :mod:`fitter.training.shapes.decimation`."""

from math import sqrt
from typing import no_type_check

import numpy as np
from numba import njit

LEAST_AGREEMENT = 0.5
"""Cosine between a triangle's normals before and after a collapse: no fold, no sliver."""


@no_type_check
@njit(cache=True, error_model="numpy", forceinline=True)
def normal_of(vertices, a, b, c, out):
    """Unit normal of a triangle into ``out``; its length, twice the area, is returned."""
    for axis in range(3):
        after, last = (axis + 1) % 3, (axis + 2) % 3
        out[axis] = (vertices[b, after] - vertices[a, after]) * (
            vertices[c, last] - vertices[a, last]
        ) - (vertices[b, last] - vertices[a, last]) * (vertices[c, after] - vertices[a, after])
    length = sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2])
    if length > 0.0:
        for axis in range(3):
            out[axis] /= length
    return length


@no_type_check
@njit(cache=True, error_model="numpy")
def collapse_independent(vertices, triangles, pointers, rings, removed, onto, owners):
    """Collapse vertices ``removed[k]`` into ``onto[k]`` in order, where the surface stays closed.

    ``pointers`` and ``rings`` list the triangles around each vertex. A collapse whose surroundings
    an earlier one has changed waits for another call. ``triangles`` is changed in place, and a
    triangle that vanishes gets -1 for its first corner; ``owners`` receives the target of each
    vertex that went. Returns how many did.
    """
    touched = np.zeros(len(vertices), dtype=np.bool_)
    # Marks of the latest collapse that looked at a vertex.
    near = np.full(len(vertices), -1, dtype=np.int64)
    before, after = np.empty(3), np.empty(3)
    done = 0
    for k in range(len(removed)):
        u, v = removed[k], onto[k]
        if touched[u] or touched[v]:
            continue
        for r in range(pointers[u], pointers[u + 1]):
            for corner in range(3):
                near[triangles[rings[r], corner]] = k
        # Around an inner edge of a closed surface exactly two vertices neighbour both of its ends.
        common = 0
        for r in range(pointers[v], pointers[v + 1]):
            for corner in range(3):
                w = triangles[rings[r], corner]
                if w != u and w != v and near[w] == k:
                    near[w] = -1
                    common += 1
        sound = common == 2
        for r in range(pointers[u], pointers[u + 1]):
            if not sound:
                break
            t = rings[r]
            a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
            if v in (a, b, c):
                continue
            normal_of(vertices, a, b, c, before)
            if a == u:
                a = v
            elif b == u:
                b = v
            else:
                c = v
            area = normal_of(vertices, a, b, c, after)
            agreement = before[0] * after[0] + before[1] * after[1] + before[2] * after[2]
            sound = area > 0.0 and agreement > LEAST_AGREEMENT
        if not sound:
            continue
        for r in range(pointers[u], pointers[u + 1]):
            t = rings[r]
            gone = False
            for corner in range(3):
                w = triangles[t, corner]
                touched[w] = True
                gone = gone or w == v
            for corner in range(3):
                if triangles[t, corner] == u:
                    triangles[t, corner] = v
            if gone:
                triangles[t, 0] = -1
        owners[u] = v
        done += 1
    return done
