"""Lay a tape: around a limb or the trunk, along landmarks, down the back. Metres throughout."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from fitter.arrays import Points3D, Vector3, Vertices
from fitter.measurement.definitions import Girth, Orientation, Selection
from fitter.measurement.plane_cut import (
    Plane,
    Polyline,
    Region,
    closed_length,
    hull_indices,
    hull_of,
    in_plane,
    plane_section,
    surrounds,
)

UP = np.array([0.0, 1.0, 0.0])

SCRAP_SHARE = 0.2
"""An open line shorter than this share of the longest is not part of what is measured: front and
back of a chest are about equal, scraps of an arm are 1 to 3 cm."""

SEARCH_CUTS = 15
"""Cuts tried along an axis before the best is refined: every 1 to 2 cm on the ranges in use."""


def girth_at_m(
    girth: Girth, region: Region, vertices: Vertices, start: Vector3, end: Vector3, fraction: float
) -> float:
    """Hull length of the cut at a fraction of the axis; NaN where the plane misses the region."""
    tape = girth_tape(girth, region, vertices, start, end, fraction)
    return float("nan") if tape is None else closed_length(tape.points)


def girth_tape(
    girth: Girth, region: Region, vertices: Vertices, start: Vector3, end: Vector3, fraction: float
) -> Polyline | None:
    """The tape whose length :func:`girth_at_m` tells, a closed line through its corners."""
    axis = end - start
    plane = Plane(point=start + fraction * axis, normal=girth_normal(girth, axis))
    cut = _under_tape(girth, region, vertices, plane)
    if cut is None:
        return None
    corners = hull_indices(in_plane(cut.points, plane))
    return Polyline(points=cut.points[corners], edges=cut.edges[corners], closed=True)


def girth_normal(girth: Girth, axis: Float[np.ndarray, "*b 3"]) -> Float[np.ndarray, "*b 3"]:
    """Unit normal of the plane of a girth whose axis points there; of many bodies at once."""
    if girth.orientation is Orientation.LEVEL:
        return np.broadcast_to(UP, axis.shape).copy()
    return axis / np.linalg.norm(axis, axis=-1, keepdims=True)


def _under_tape(girth: Girth, region: Region, vertices: Vertices, plane: Plane) -> Polyline | None:
    """The cut that a tape goes round, as one line; None where the plane misses the region."""
    lines = plane_section(vertices, region, plane)
    if not lines:
        return None
    lines = _without_scraps(lines)
    if girth.around_axis and len(lines) > 1:
        lines = (_line_around(lines, plane),)
    if len(lines) == 1:
        return lines[0]
    return Polyline(
        points=np.concatenate([line.points for line in lines]),
        edges=np.concatenate([line.edges for line in lines]),
        closed=False,
    )


def girth_placement(
    girth: Girth, region: Region, vertices: Vertices, start: Vector3, end: Vector3
) -> float:
    """The fraction of the axis where the girth is largest or smallest within its range.

    A scan, then one parabola through the best cut and its neighbours.
    """
    low, high = girth.fractions
    if low == high:
        return low
    fractions = np.linspace(low, high, SEARCH_CUTS)
    sign = 1.0 if girth.selection is Selection.LARGEST else -1.0

    def score(fraction: float) -> float:
        return sign * girth_at_m(girth, region, vertices, start, end, fraction)

    scores = np.array([score(fraction) for fraction in fractions])
    best = int(np.nanargmax(scores))
    if best in (0, SEARCH_CUTS - 1):
        return float(fractions[best])
    before, at, after = scores[best - 1 : best + 2]
    bend = before - 2.0 * at + after
    if not bend < 0.0:
        return float(fractions[best])
    step = fractions[1] - fractions[0]
    peak = float(fractions[best] + 0.5 * step * (before - after) / bend)
    return peak if score(peak) > at else float(fractions[best])


def path_length_m(points: Points3D | Sequence[Vector3]) -> float:
    """Sum of straight distances from point to point."""
    return float(np.linalg.norm(np.diff(np.asarray(points), axis=0), axis=1).sum())


def back_contour_m(region: Region, vertices: Vertices, top: Vector3, bottom: Vector3) -> float:
    """Length of :func:`back_contour`; NaN where the plane misses the region."""
    taut = back_contour(region, vertices, top, bottom)
    return path_length_m(taut) if len(taut) else float("nan")


def back_contour(region: Region, vertices: Vertices, top: Vector3, bottom: Vector3) -> Points3D:
    """A tape laid taut down the back in the sagittal plane through ``top``, to ``bottom``'s height.

    The tape touches what stands out and spans the hollow of the back: it is the rear side of the
    convex hull between both heights. (k, 3); empty where the plane misses the region.
    """
    sagittal = Plane(point=top, normal=np.array([1.0, 0.0, 0.0]))
    lines = plane_section(vertices, region, sagittal)
    if not lines:
        return np.zeros((0, 3))
    rear = _rear_line(lines, top[1], bottom[1])
    # (y, -z): the hull's far side along the second axis is the person's back.
    taut = _upper_chain(np.stack([rear[:, 1], -rear[:, 2]], axis=1))
    return np.stack([np.full(len(taut), top[0]), taut[:, 0], -taut[:, 1]], axis=1)


def _without_scraps(lines: Sequence[Polyline]) -> Sequence[Polyline]:
    """The lines a tape goes round.

    Where a line closes, open ones lie on a limb beyond the region's border. Above the armpits,
    where none closes, front and back are what the tape spans, and short ones are such scraps: they
    come and go as the plane moves, and a girth that took them in would jump by 6 mm.
    """
    closed = tuple(line for line in lines if line.closed)
    if closed or len(lines) == 1:
        return closed or lines
    lengths = [path_length_m(line.points) for line in lines]
    return [
        line
        for line, length in zip(lines, lengths, strict=True)
        if length > SCRAP_SHARE * max(lengths)
    ]


def _line_around(lines: Sequence[Polyline], plane: Plane) -> Polyline:
    """The line whose hull contains the plane's point, else the one whose middle is nearest."""

    def rank(line: Polyline) -> tuple[bool, float]:
        hull = hull_of(in_plane(line.points, plane))
        return (
            not surrounds(hull, np.zeros(2)),
            float(np.linalg.norm(line.points.mean(axis=0) - plane.point)),
        )

    return min(lines, key=rank)


def _rear_line(lines: Sequence[Polyline], top: float, bottom: float) -> Points3D:
    """Points of the rear surface between two heights, with the surface at both heights itself."""
    starts: list[np.ndarray] = []
    ends: list[np.ndarray] = []
    for line in lines:
        following = np.roll(line.points, -1, axis=0)
        count = len(line.points) if line.closed else len(line.points) - 1
        starts.append(line.points[:count])
        ends.append(following[:count])
    a, b = np.concatenate(starts), np.concatenate(ends)
    borders = [_rearmost_at(a, b, height) for height in (bottom, top)]
    inside = a[(a[:, 1] > bottom) & (a[:, 1] < top)]
    return np.concatenate([inside, np.stack(borders)])


def _rearmost_at(a: Points3D, b: Points3D, height: float) -> Vector3:
    crossing = (a[:, 1] < height) != (b[:, 1] < height)
    if not crossing.any():
        return np.full(3, np.nan)
    a, b = a[crossing], b[crossing]
    along = (height - a[:, 1]) / (b[:, 1] - a[:, 1])
    points = a + along[:, None] * (b - a)
    return points[np.argmin(points[:, 2])]


def _upper_chain(points: np.ndarray) -> np.ndarray:
    """The upper convex chain from the leftmost to the rightmost of the points."""
    if not np.isfinite(points).all():
        return np.full((2, 2), np.nan)
    hull = hull_of(points)
    left, right = int(np.argmin(hull[:, 0])), int(np.argmax(hull[:, 0]))
    # Counter-clockwise, the upper chain runs from right to left.
    stop = left if left >= right else left + len(hull)
    return hull[np.arange(right, stop + 1) % len(hull)]
