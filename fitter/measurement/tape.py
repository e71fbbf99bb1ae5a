"""Lay a tape: around a limb or the trunk, along landmarks, down the back. Metres throughout."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Points2D, Points3D, Vector3, Vertices
from fitter.measurement._girth_kernels import Part, girth_corners, girth_lengths
from fitter.measurement.definitions import Girth, Orientation, Selection
from fitter.measurement.plane_cut import (
    Plane,
    Polyline,
    Region,
    hull_indices,
    plane_section,
)

UP, SIDEWAYS = np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0])

UNKNOWN = -1
"""In place of an edge's vertices."""

SEARCH_CUTS = 15
"""Cuts tried along an axis before the best is refined: every 1 to 2 cm on the ranges in use."""


def girth_at_m(
    girth: Girth, region: Region, vertices: Vertices, start: Vector3, end: Vector3, fraction: float
) -> float:
    """Hull length of the cut at a fraction of the axis; NaN where the plane misses the region."""
    return float(_lengths(girth, region, vertices, start, end, np.array([fraction]))[0])


def girth_tape(
    girth: Girth, region: Region, vertices: Vertices, start: Vector3, end: Vector3, fraction: float
) -> Polyline | None:
    """The tape whose length :func:`girth_at_m` tells, a closed line through its corners."""
    axis = end - start
    points, edges = girth_corners(
        np.ascontiguousarray(vertices),
        _part(region),
        start + fraction * axis,
        girth_normal(girth, axis),
        girth.around_axis,
    )
    return Polyline(points=points, edges=edges, closed=True) if len(points) else None


def _lengths(
    girth: Girth,
    region: Region,
    vertices: Vertices,
    start: Vector3,
    end: Vector3,
    fractions: Float[np.ndarray, " cuts"],
) -> Float[np.ndarray, " cuts"]:
    axis = end - start
    return girth_lengths(
        np.ascontiguousarray(vertices),
        _part(region),
        start,
        axis,
        girth_normal(girth, axis),
        fractions,
        girth.around_axis,
    )


def _part(region: Region) -> Part:
    return Part(
        shares=region.shares,
        triangles=region.triangles,
        neighbours=region.neighbours,
        allowed=region.allowed,
        members=region.members,
        vertices=region.vertices,
    )


def girth_normal(girth: Girth, axis: Float[np.ndarray, "*b 3"]) -> Float[np.ndarray, "*b 3"]:
    """Unit normal of the plane of a girth whose axis points there; of many bodies at once."""
    if girth.orientation is Orientation.LEVEL:
        return np.broadcast_to(UP, axis.shape).copy()
    return axis / np.linalg.norm(axis, axis=-1, keepdims=True)


def girth_placement(
    girth: Girth, region: Region, vertices: Vertices, start: Vector3, end: Vector3
) -> float:
    """The fraction of the axis where the girth is largest or smallest within its range.

    Even steps, then one parabola through the best cut and its neighbours.
    """
    low, high = girth.fractions
    if low == high:
        return low
    fractions = np.linspace(low, high, SEARCH_CUTS)
    sign = 1.0 if girth.selection is Selection.LARGEST else -1.0

    scores = sign * _lengths(girth, region, vertices, start, end, fractions)
    best = int(np.nanargmax(scores))
    if best in (0, SEARCH_CUTS - 1):
        return float(fractions[best])
    before, at, after = scores[best - 1 : best + 2]
    bend = before - 2.0 * at + after
    if not bend < 0.0:
        return float(fractions[best])
    step = fractions[1] - fractions[0]
    peak = float(fractions[best] + 0.5 * step * (before - after) / bend)
    score = sign * girth_at_m(girth, region, vertices, start, end, peak)
    return peak if score > at else float(fractions[best])


def path_length_m(points: Points3D | Sequence[Vector3]) -> float:
    """Sum of straight distances from point to point."""
    return float(np.linalg.norm(np.diff(np.asarray(points), axis=0), axis=1).sum())


def back_contour_m(back: Polyline) -> float:
    """Length of a :func:`back_contour`; NaN where its plane misses the region."""
    return path_length_m(back.points) if len(back.points) else float("nan")


def back_contour(region: Region, vertices: Vertices, top: Vector3, bottom: Vector3) -> Polyline:
    """A tape laid taut down the back in the sagittal plane through ``top``, to ``bottom``'s height.

    The tape touches what stands out and spans the hollow of the back: it is the rear side of the
    convex hull between both heights. Both its ends lie between two edges of the mesh; where one of
    these is unknown, for the region ends there, edges are -1. Empty where the plane misses the
    region.
    """
    lines = plane_section(vertices, region, Plane(point=top, normal=SIDEWAYS))
    if not lines:
        return Polyline(
            points=np.zeros((0, 3)), edges=np.zeros((0, 2, 2), dtype=np.int64), closed=False
        )
    rear = _rear_line(lines, top[1], bottom[1])
    if not np.isfinite(rear.points).all():
        missed = np.full((2, 2, 2), UNKNOWN)
        return Polyline(points=np.full((2, 3), np.nan), edges=missed, closed=False)
    # (y, -z): the hull's far side along the second axis is the person's back.
    taut = _upper_chain(np.stack([rear.points[:, 1], -rear.points[:, 2]], axis=1))
    points = rear.points[taut]
    points[:, 0] = top[0]
    return Polyline(points=points, edges=rear.edges[taut], closed=False)


def _rear_line(lines: Sequence[Polyline], top: float, bottom: float) -> Polyline:
    """Points of the rear surface between two heights, with the surface at both heights itself."""
    starts, ends, edges, end_edges = ([] for _ in range(4))
    for line in lines:
        count = len(line.points) if line.closed else len(line.points) - 1
        starts.append(line.points[:count])
        ends.append(np.roll(line.points, -1, axis=0)[:count])
        edges.append(line.edges[:count])
        end_edges.append(np.roll(line.edges, -1, axis=0)[:count])
    a, b = np.concatenate(starts), np.concatenate(ends)
    edges_a, edges_b = np.concatenate(edges), np.concatenate(end_edges)
    inside = (a[:, 1] > bottom) & (a[:, 1] < top)
    at_heights = [_rearmost_at(a, b, edges_a, edges_b, height) for height in (bottom, top)]
    return Polyline(
        points=np.concatenate([a[inside], *(each.points for each in at_heights)]),
        edges=np.concatenate([edges_a[inside], *(each.edges for each in at_heights)]),
        closed=False,
    )


def _rearmost_at(
    a: Points3D,
    b: Points3D,
    edges_a: Integer[np.ndarray, "k 2 2"],
    edges_b: Integer[np.ndarray, "k 2 2"],
    height: float,
) -> Polyline:
    """The rearmost point of steps from a to b at a height, and the edges it lies between."""
    crossing = np.flatnonzero((a[:, 1] < height) != (b[:, 1] < height))
    if not len(crossing):
        return Polyline(
            points=np.full((1, 3), np.nan), edges=np.full((1, 2, 2), UNKNOWN), closed=False
        )
    from_, to = a[crossing], b[crossing]
    along = (height - from_[:, 1]) / (to[:, 1] - from_[:, 1])
    points = from_ + along[:, None] * (to - from_)
    rearmost = int(np.argmin(points[:, 2]))
    between = np.stack([edges_a[crossing[rearmost]], edges_b[crossing[rearmost]]])
    is_known = (between[:, 0] == between[:, 1]).all()
    return Polyline(
        points=points[rearmost, None],
        edges=(between[:, 0] if is_known else np.full((2, 2), UNKNOWN))[None],
        closed=False,
    )


def _upper_chain(points: Points2D) -> Integer[np.ndarray, " corners"]:
    """Indices of the upper convex chain, from the rightmost to the leftmost."""
    hull = hull_indices(points)
    along = points[hull, 0]
    left, right = int(np.argmin(along)), int(np.argmax(along))
    # Counter-clockwise, the upper chain runs from right to left.
    stop = left if left >= right else left + len(hull)
    return hull[np.arange(right, stop + 1) % len(hull)]
