"""Compiled plane cuts and convex hulls; :mod:`fitter.measurement.plane_cut` carries the shapes."""

from typing import no_type_check

import numpy as np
from numba import njit

BORDER_SHARE = 0.5
"""A region ends where vertices belong to it by half."""


@no_type_check
@njit(cache=True)
def _is_crossed(heights, triangle, corner):
    """A vertex in the plane counts as above it, so every triangle has two crossed edges or none."""
    return (heights[triangle[corner]] >= 0.0) != (heights[triangle[(corner + 1) % 3]] >= 0.0)


@no_type_check
@njit(cache=True)
def _crossing(vertices, shares, heights, triangle, corner, out, edge):
    # Coordinates and share, and the edge. From the lower vertex id to the higher, so that both
    # triangles of an edge find one point.
    low = min(triangle[corner], triangle[(corner + 1) % 3])
    high = max(triangle[corner], triangle[(corner + 1) % 3])
    along = heights[low] / (heights[low] - heights[high])
    for axis in range(3):
        out[axis] = vertices[low, axis] + along * (vertices[high, axis] - vertices[low, axis])
    out[3] = shares[low] + along * (shares[high] - shares[low])
    edge[0] = low
    edge[1] = high


@no_type_check
@njit(cache=True)
def _other_crossed_edge(heights, triangle, entry):
    for step in range(1, 3):
        corner = (entry + step) % 3
        if _is_crossed(heights, triangle, corner):
            return corner
    return -1


@no_type_check
@njit(cache=True)
def _walk(
    vertices, shares, heights, triangles, neighbours, allowed, visited, start, entry,
    out, edges, count,
):  # fmt: skip
    """Follow the cut from triangle ``start``, in through edge ``entry``; True if it closes."""
    current = start
    while True:
        visited[current] = True
        leave = _other_crossed_edge(heights, triangles[current], entry)
        _crossing(vertices, shares, heights, triangles[current], leave, out[count], edges[count])
        count += 1
        following = neighbours[current, leave]
        if following == start:
            return True, count
        if following < 0 or not allowed[following] or visited[following]:
            return False, count
        a = triangles[current, leave]
        b = triangles[current, (leave + 1) % 3]
        for corner in range(3):
            c = triangles[following, corner]
            d = triangles[following, (corner + 1) % 3]
            if (c == b and d == a) or (c == a and d == b):
                entry = corner
        current = following


@no_type_check
@njit(cache=True)
def trace_lines(vertices, shares, triangles, neighbours, allowed, candidates, heights, visited):
    """Lines of :func:`trace_section`, of heights above the plane that are known.

    ``candidates`` may be all triangles or those that the plane crosses; ``visited`` is false for
    each of them before, and true for those on the lines after.
    """
    points = np.empty((2 * candidates.size + 2, 4))
    behind = np.empty((candidates.size + 1, 4))
    edges = np.empty((2 * candidates.size + 2, 2), dtype=np.int64)
    edges_behind = np.empty((candidates.size + 1, 2), dtype=np.int64)
    starts = np.empty(candidates.size + 1, dtype=np.int64)
    closed = np.empty(candidates.size + 1, dtype=np.bool_)
    total = 0
    lines = 0
    for index in range(candidates.size):
        t = candidates[index]
        if visited[t]:
            continue
        entry = -1
        for corner in range(3):
            if _is_crossed(heights, triangles[t], corner):
                entry = corner
                break
        if entry < 0:
            continue
        starts[lines] = total
        closes, count = _walk(
            vertices, shares, heights, triangles, neighbours, allowed, visited, t, entry,
            points[total:], edges[total:], 0,
        )  # fmt: skip
        if not closes:
            back = 0
            leave = _other_crossed_edge(heights, triangles[t], entry)
            _, back = _walk(
                vertices, shares, heights, triangles, neighbours, allowed, visited, t, leave,
                behind, edges_behind, 0,
            )  # fmt: skip
            for k in range(count - 1, -1, -1):
                points[total + back + k] = points[total + k]
                edges[total + back + k] = edges[total + k]
            for k in range(back):
                points[total + k] = behind[back - 1 - k]
                edges[total + k] = edges_behind[back - 1 - k]
            count += back
        closed[lines] = closes
        total += count
        lines += 1
    starts[lines] = total
    return (
        points[:total].copy(),
        edges[:total].copy(),
        starts[: lines + 1].copy(),
        closed[:lines].copy(),
    )


@no_type_check
@njit(cache=True)
def trace_section(
    vertices, shares, triangles, neighbours, allowed, candidates, candidate_vertices, point, normal
):
    """Polylines of a plane cut, one after the other.

    Returns the points with their shares in a fourth column, the edges they lie on, where each
    polyline starts, and whether it closes.
    """
    visited = np.zeros(triangles.shape[0], dtype=np.bool_)
    heights = np.empty(vertices.shape[0])
    for v in candidate_vertices:
        heights[v] = (
            (vertices[v, 0] - point[0]) * normal[0]
            + (vertices[v, 1] - point[1]) * normal[1]
            + (vertices[v, 2] - point[2]) * normal[2]
        )
    return trace_lines(
        vertices, shares, triangles, neighbours, allowed, candidates, heights, visited
    )


@no_type_check
@njit(cache=True)
def _turns_left(points, a, b, c):
    return (points[b, 0] - points[a, 0]) * (points[c, 1] - points[a, 1]) - (
        points[b, 1] - points[a, 1]
    ) * (points[c, 0] - points[a, 0]) > 0.0


@no_type_check
@njit(cache=True)
def convex_hull(points):
    """Indices of the convex hull, counter-clockwise (Andrew's monotone chain)."""
    count = points.shape[0]
    order = np.argsort(points[:, 0])
    for k in range(1, count):
        # Of points with one first coordinate the one with the lower second comes first.
        place, at = order[k], k
        while (
            at > 0
            and points[order[at - 1], 0] == points[place, 0]
            and points[order[at - 1], 1] > points[place, 1]
        ):
            order[at] = order[at - 1]
            at -= 1
        order[at] = place
    hull = np.empty(2 * count + 1, dtype=np.int64)
    size = 0
    for k in range(count):
        while size >= 2 and not _turns_left(points, hull[size - 2], hull[size - 1], order[k]):
            size -= 1
        hull[size] = order[k]
        size += 1
    lower = size + 1
    for k in range(count - 2, -1, -1):
        while size >= lower and not _turns_left(points, hull[size - 2], hull[size - 1], order[k]):
            size -= 1
        hull[size] = order[k]
        size += 1
    return hull[: max(size - 1, 1)].copy()


@no_type_check
@njit(cache=True)
def flatten(points, origin, normal):
    """Coordinates along two orthonormal directions of the plane through ``origin``."""
    axis = np.argmin(np.abs(normal))
    helper = np.zeros(3)
    helper[axis] = 1.0
    first = np.cross(normal, helper)
    first /= np.sqrt(first @ first)
    second = np.cross(normal, first)
    flat = np.empty((points.shape[0], 2))
    for k in range(points.shape[0]):
        u = 0.0
        v = 0.0
        for axis in range(3):
            offset = points[k, axis] - origin[axis]
            u += offset * first[axis]
            v += offset * second[axis]
        flat[k, 0] = u
        flat[k, 1] = v
    return flat


@no_type_check
@njit(cache=True)
def polygon_length(points):
    """Length of the closed polygon through the points."""
    total = 0.0
    for k in range(points.shape[0]):
        squared = 0.0
        for axis in range(points.shape[1]):
            squared += (points[k, axis] - points[k - 1, axis]) ** 2
        total += np.sqrt(squared)
    return total
