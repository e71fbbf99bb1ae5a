"""Compiled taut tapes over the skin; :mod:`fitter.measurement.contour` carries the shapes."""

from typing import no_type_check

import numpy as np
from numba import njit

from fitter.measurement._section_kernels import convex_hull

STEEPEST = 3.0
"""Slope at which a tape leaves its ends at most, from the straight line between them: 72 degrees.
Where skin bulges beyond an end, the points of a cut pass the end one by one as shapes change; a
tape that reached up to each of them until it is past would jump by 3 mm."""


@no_type_check
@njit(cache=True)
def taut_chain(
    vertices, shares, triangles, members, member_vertices, start, along, outward, normal, length
):
    """Corners (u, v) of the tape from (0, 0) to (``length``, 0), in that order, and their edges.

    Skin counts where the plane through ``start`` cuts it, between both ends along the tape; no
    order of it is needed, for the tape is the outer side of its convex hull.
    """
    heights = np.empty(vertices.shape[0])
    for v in member_vertices:
        heights[v] = (
            (vertices[v, 0] - start[0]) * normal[0]
            + (vertices[v, 1] - start[1]) * normal[1]
            + (vertices[v, 2] - start[2]) * normal[2]
        )
    flat = np.empty((2 * members.size + 2, 2))
    edges = np.full((2 * members.size + 2, 2), -1, dtype=np.int64)
    flat[0] = 0.0
    flat[1, 0] = length
    flat[1, 1] = 0.0
    count = 2
    point = np.empty(3)
    for t in members:
        for corner in range(3):
            low = triangles[t, corner]
            high = triangles[t, (corner + 1) % 3]
            # Of the two triangles at an edge one has its vertices in ascending order.
            if low > high or (heights[low] >= 0.0) == (heights[high] >= 0.0):
                continue
            share = heights[low] / (heights[low] - heights[high])
            if shares[low] + share * (shares[high] - shares[low]) < 0.5:
                continue
            for axis in range(3):
                point[axis] = (
                    vertices[low, axis]
                    + share * (vertices[high, axis] - vertices[low, axis])
                    - start[axis]
                )
            u = point[0] * along[0] + point[1] * along[1] + point[2] * along[2]
            v = point[0] * outward[0] + point[1] * outward[1] + point[2] * outward[2]
            if v > 0.0 and 0.0 < u < length:
                flat[count, 0] = u
                flat[count, 1] = min(v, STEEPEST * u, STEEPEST * (length - u))
                edges[count, 0] = low
                edges[count, 1] = high
                count += 1
    hull = convex_hull(flat[:count])
    # Counter-clockwise, with both ends below all else: from the first end on, the chain runs
    # backwards from its last corner.
    first = 0
    for k in range(hull.size):
        if hull[k] == 0:
            first = k
    chain = np.empty((hull.size, 2))
    chain_edges = np.empty((hull.size, 2), dtype=np.int64)
    for k in range(hull.size):
        chain[k] = flat[hull[(first - k) % hull.size]]
        chain_edges[k] = edges[hull[(first - k) % hull.size]]
    return chain, chain_edges


@no_type_check
@njit(cache=True, error_model="numpy")
def crossings(vertices, displacements, step, edges, point, normal):
    """Crossings of b planes with the edges (c, 2) of b bodies, and how far beyond an edge at most.

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
