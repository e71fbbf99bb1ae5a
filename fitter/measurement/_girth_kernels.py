"""Compiled girths, from cut to tape; :mod:`fitter.measurement.tape` carries the shapes."""

from typing import NamedTuple, no_type_check

import numpy as np
from numba import njit

from fitter.measurement._section_kernels import (
    BORDER_SHARE,
    convex_hull,
    flatten,
    polygon_length,
    trace_lines,
)

SCRAP_SHARE = 0.2
"""An open line shorter than this share of the longest is not part of what is measured: front and
back of a chest are about equal, scraps of an arm are 1 to 3 cm."""


class Part(NamedTuple):
    """The arrays of a :class:`~fitter.measurement.plane_cut.Region`."""

    shares: np.ndarray
    triangles: np.ndarray
    neighbours: np.ndarray
    allowed: np.ndarray
    members: np.ndarray
    vertices: np.ndarray


class Heights(NamedTuple):
    """Vertices along a normal, and the lowest and highest corner of each of a part's triangles."""

    vertices: np.ndarray
    lowest: np.ndarray
    highest: np.ndarray


@no_type_check
@njit(cache=True)
def girth_lengths(vertices, part, start, axis, normal, fractions, around_axis):
    """Lengths of the tapes at fractions of an axis; NaN where the plane misses the region."""
    heights = _heights(vertices, part, normal)
    lengths = np.empty(fractions.size)
    for k in range(fractions.size):
        point = start + fractions[k] * axis
        points, _ = _tape(vertices, part, heights, point, normal, around_axis)
        lengths[k] = polygon_length(points) if points.shape[0] else np.nan
    return lengths


@no_type_check
@njit(cache=True)
def girth_corners(vertices, part, point, normal, around_axis):
    """Corners (k, 3) of the tape in one plane and the edges (k, 2, 2) they lie on; none: missed."""
    heights = _heights(vertices, part, normal)
    return _tape(vertices, part, heights, point, normal, around_axis)


@no_type_check
@njit(cache=True)
def _heights(vertices, part, normal):
    triangles, members = part.triangles, part.members
    heights = np.empty(vertices.shape[0])
    for v in part.vertices:
        heights[v] = (
            vertices[v, 0] * normal[0] + vertices[v, 1] * normal[1] + vertices[v, 2] * normal[2]
        )
    lowest = np.empty(members.size)
    highest = np.empty(members.size)
    for index in range(members.size):
        t = members[index]
        a = heights[triangles[t, 0]]
        b = heights[triangles[t, 1]]
        c = heights[triangles[t, 2]]
        lowest[index] = min(a, b, c)
        highest[index] = max(a, b, c)
    return Heights(heights, lowest, highest)


@no_type_check
@njit(cache=True)
def _tape(vertices, part, heights, point, normal, around_axis):
    triangles, members = part.triangles, part.members
    level = point[0] * normal[0] + point[1] * normal[1] + point[2] * normal[2]
    crossed = np.empty(members.size, dtype=np.int64)
    count = 0
    for index in range(members.size):
        crossed[count] = members[index]
        # A vertex in the plane counts as above it.
        count += (heights.lowest[index] < level) & (heights.highest[index] >= level)
    crossed = crossed[:count]
    above = np.empty(vertices.shape[0])
    for index in range(count):
        for corner in range(3):
            v = triangles[crossed[index], corner]
            above[v] = heights.vertices[v] - level
    visited = np.zeros(triangles.shape[0], dtype=np.bool_)
    cut, cut_edges, starts, closed = trace_lines(
        vertices, part.shares, triangles, part.neighbours, part.allowed, crossed, above, visited
    )
    points, edges, starts, closed = _stretches(cut, cut_edges, starts, closed)
    if closed.size == 0:
        return points, edges
    kept = _without_scraps(points, starts, closed)
    if around_axis and np.sum(kept) > 1:
        kept = _around(points, starts, kept, point, normal)
    chosen = np.empty(points.shape[0], dtype=np.bool_)
    for line in range(closed.size):
        chosen[starts[line] : starts[line + 1]] = kept[line]
    points, edges = points[chosen], edges[chosen]
    corners = convex_hull(flatten(points, point, normal))
    return points[corners], edges[corners]


@no_type_check
@njit(cache=True)
def _stretches(cut, cut_edges, starts, closed):
    """The parts of each line that lie in the region, ending where the share is the border's."""
    # A line of n points has at most n / 2 stretches, each with two ends more.
    points = np.empty((2 * cut.shape[0] + 2, 3))
    edges = np.empty((2 * cut.shape[0] + 2, 2, 2), dtype=np.int64)
    new_starts = np.empty(cut.shape[0] + 2, dtype=np.int64)
    new_closed = np.empty(cut.shape[0] + 1, dtype=np.bool_)
    total = 0
    lines = 0
    for line in range(closed.size):
        first, size = starts[line], starts[line + 1] - starts[line]
        lowest = first + np.argmin(cut[first : first + size, 3])
        if cut[lowest, 3] >= BORDER_SHARE:
            new_starts[lines] = total
            new_closed[lines] = closed[line]
            for k in range(first, first + size):
                points[total] = cut[k, :3]
                edges[total, 0] = cut_edges[k]
                edges[total, 1] = cut_edges[k]
                total += 1
            lines += 1
            continue
        # A closed line begins and ends at its point that is farthest outside.
        turn = lowest - first if closed[line] else 0
        length = size + 1 if closed[line] else size
        within = False
        for step in range(length):
            k = first + (turn + step) % size
            before = first + (turn + step - 1) % size
            inside = cut[k, 3] >= BORDER_SHARE
            if inside and not within:
                new_starts[lines] = total
                new_closed[lines] = False
            if inside != within and step > 0:
                along = (BORDER_SHARE - cut[before, 3]) / (cut[k, 3] - cut[before, 3])
                for axis in range(3):
                    points[total, axis] = cut[before, axis] + along * (
                        cut[k, axis] - cut[before, axis]
                    )
                edges[total, 0] = cut_edges[before]
                edges[total, 1] = cut_edges[k]
                total += 1
            if inside:
                points[total] = cut[k, :3]
                edges[total, 0] = cut_edges[k]
                edges[total, 1] = cut_edges[k]
                total += 1
            elif within:
                lines += 1
            within = inside
        if within:
            lines += 1
    new_starts[lines] = total
    return points[:total], edges[:total], new_starts[: lines + 1], new_closed[:lines]


@no_type_check
@njit(cache=True)
def _without_scraps(points, starts, closed):
    """The lines that a tape goes round.

    Where a line closes, open ones lie on a limb beyond the region's border. Above the armpits,
    where none closes, front and back are what the tape spans, and short ones are such scraps: they
    come and go as the plane moves, and a girth that took them in would jump by 6 mm.
    """
    if closed.any() or closed.size == 1:
        return closed if closed.any() else ~closed
    lengths = np.zeros(closed.size)
    for line in range(closed.size):
        for k in range(starts[line], starts[line + 1] - 1):
            step = points[k + 1] - points[k]
            lengths[line] += np.sqrt(step[0] ** 2 + step[1] ** 2 + step[2] ** 2)
    return lengths > SCRAP_SHARE * lengths.max()


@no_type_check
@njit(cache=True)
def _around(points, starts, kept, point, normal):
    """The kept line whose hull holds the point, else the one whose middle is nearest to it."""
    best = -1
    best_surrounds = False
    best_distance = np.inf
    for line in range(kept.size):
        if not kept[line]:
            continue
        along = points[starts[line] : starts[line + 1]]
        flat = flatten(along, point, normal)
        corners = convex_hull(flat)
        surrounds = True
        for k in range(corners.size):
            a = flat[corners[k]]
            b = flat[corners[(k + 1) % corners.size]]
            surrounds &= (b[1] - a[1]) * a[0] - (b[0] - a[0]) * a[1] >= 0.0
        squared = 0.0
        for axis in range(3):
            squared += (np.mean(along[:, axis]) - point[axis]) ** 2
        distance = np.sqrt(squared)
        if (
            best < 0
            or surrounds > best_surrounds
            or (surrounds == best_surrounds and distance < best_distance)
        ):
            best, best_surrounds, best_distance = line, surrounds, distance
    only = np.zeros(kept.size, dtype=np.bool_)
    only[best] = True
    return only
