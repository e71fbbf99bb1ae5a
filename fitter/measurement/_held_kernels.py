"""Compiled crossings of many bodies; :mod:`fitter.measurement.held_tapes` carries the shapes."""

from typing import no_type_check

import numpy as np
from numba import njit


@no_type_check
@njit(cache=True, error_model="numpy")
def crossings(vertices, displacements, step, edges, point, normal):
    """Where b planes cross the edges (c, 2) of b bodies, and how far beyond an edge at most.

    Returns the share of each edge (b, c), the points (b, c, 3), and metres.
    """
    bodies, count = displacements.shape[0], edges.shape[0]
    along = np.empty((bodies, count))
    points = np.empty((bodies, count, 3))
    beyond = 0.0
    low = np.empty(3)
    high = np.empty(3)
    for body in range(bodies):
        for c in range(count):
            first, second = edges[c, 0], edges[c, 1]
            below = 0.0
            above = 0.0
            squared = 0.0
            for axis in range(3):
                low[axis] = vertices[first, axis] + step * displacements[body, first, axis]
                high[axis] = vertices[second, axis] + step * displacements[body, second, axis]
                below += (low[axis] - point[body, axis]) * normal[body, axis]
                above += (high[axis] - point[body, axis]) * normal[body, axis]
                squared += (high[axis] - low[axis]) ** 2
            share = below / (below - above)
            along[body, c] = share
            for axis in range(3):
                points[body, c, axis] = low[axis] + share * (high[axis] - low[axis])
            beyond = max(beyond, max(-share, share - 1.0) * np.sqrt(squared))
    return along, points, beyond
