"""Slices of a mesh and the tape around them.

Section 6: girths are "computed by transforming the body to a canonical pose, slicing the mesh on a
fixed plane and computing the convex hull of the contour", because a tape spans hollows.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Integer

from fitter.arrays import PerVertex, Points2D, Points3D, Triangles, Vector3, Vertices
from fitter.measurement._section_kernels import (
    BORDER_SHARE,
    convex_hull,
    polygon_length,
    trace_section,
)
from fitter.numerics.meshes import triangle_neighbours


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Plane:
    """A plane through ``point`` with unit ``normal``, in the frame of the vertices it cuts."""

    point: Vector3
    normal: Vector3


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Region:
    """The triangles a cut may run over, with the mesh's adjacency.

    Attributes
    ----------
    triangles, neighbours
        (f, 3) of the whole mesh.
    allowed
        (f,) which triangles belong to the region.
    shares
        (m,) how far each vertex belongs to the region. Lines of a cut end where the share, linear
        over every triangle, falls to a half: a smooth border, where one along triangles' edges
        would let a girth jump as the plane passes from triangle to triangle.
    members, vertices
        Ids of the allowed triangles and of their corners, ascending.
    """

    triangles: Triangles
    neighbours: Integer[np.ndarray, "f 3"]
    allowed: Bool[np.ndarray, " f"]
    shares: PerVertex
    members: Integer[np.ndarray, " r"]
    vertices: Integer[np.ndarray, " c"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Polyline:
    """Line in which a plane cuts a region: a closed loop, or an open one that ends at its border.

    ``edges`` are the vertices of the mesh edges on which the points lie. Each lies on two: a point
    of the border between its crossings with both, every other on one that is named twice.
    """

    points: Points3D
    edges: Integer[np.ndarray, "k 2 2"]
    closed: bool


def whole_mesh(triangles: Triangles) -> Region:
    """The region of all triangles."""
    triangles = np.ascontiguousarray(triangles, dtype=np.int32)
    everything = np.ones(len(triangles), dtype=np.bool_)
    shares = np.ones(int(triangles.max()) + 1)
    return _region(triangles, triangle_neighbours(triangles), everything, shares)


def restricted(region: Region, shares: PerVertex) -> Region:
    """The part of a region whose vertices belong by half or more to something else too.

    Parameters
    ----------
    region
        What is restricted.
    shares
        (m,) from 0 to 1.
    """
    shares = np.minimum(region.shares, shares)
    touched = (shares >= BORDER_SHARE)[region.triangles].any(axis=1)
    return _region(region.triangles, region.neighbours, region.allowed & touched, shares)


def _region(
    triangles: Triangles,
    neighbours: Integer[np.ndarray, "f 3"],
    allowed: Bool[np.ndarray, " f"],
    shares: PerVertex,
) -> Region:
    return Region(
        triangles=triangles,
        neighbours=neighbours,
        allowed=allowed,
        shares=np.ascontiguousarray(shares, dtype=np.float64),
        members=np.flatnonzero(allowed),
        vertices=np.unique(triangles[allowed]),
    )


def plane_section(vertices: Vertices, region: Region, plane: Plane) -> tuple[Polyline, ...]:
    """Every polyline in which ``plane`` cuts ``region``, in the frame of ``vertices``."""
    points, edges, starts, closed = trace_section(
        np.ascontiguousarray(vertices),
        region.shares,
        region.triangles,
        region.neighbours,
        region.allowed,
        region.members,
        region.vertices,
        plane.point,
        plane.normal,
    )
    lines: list[Polyline] = []
    for start, stop, is_closed in zip(starts[:-1], starts[1:], closed, strict=True):
        line, shares = points[start:stop, :3], points[start:stop, 3]
        if (shares >= BORDER_SHARE).all():
            lines.append(
                Polyline(
                    points=np.ascontiguousarray(line),
                    edges=np.stack([edges[start:stop]] * 2, axis=1),
                    closed=bool(is_closed),
                )
            )
        else:
            lines.extend(_within(line, edges[start:stop], shares, closed=bool(is_closed)))
    return tuple(lines)


def _within(
    points: Points3D,
    edges: Integer[np.ndarray, "k 2"],
    shares: Float[np.ndarray, " k"],
    *,
    closed: bool,
) -> list[Polyline]:
    """The stretches of a line that lie in the region, ending where the share is the border's."""
    if closed:
        first = int(np.argmin(shares))
        turn = (np.arange(len(points) + 1) + first) % len(points)
        points, edges, shares = points[turn], edges[turn], shares[turn]
    inside = shares >= BORDER_SHARE
    stretches: list[Polyline] = []
    # Runs of points inside, as pairs of (first, one past the last).
    steps = np.flatnonzero(np.diff(np.concatenate([[False], inside, [False]])))
    for start, stop in steps.reshape(-1, 2).tolist():
        run = [points[start:stop]]
        on = [np.stack([edges[start:stop]] * 2, axis=1)]
        if start > 0:
            run.insert(0, _border_point(points, shares, start - 1)[None])
            on.insert(0, edges[None, start - 1 : start + 1])
        if stop < len(points):
            run.append(_border_point(points, shares, stop - 1)[None])
            on.append(edges[None, stop - 1 : stop + 1])
        stretches.append(
            Polyline(points=np.concatenate(run), edges=np.concatenate(on), closed=False)
        )
    return stretches


def _border_point(points: Points3D, shares: Float[np.ndarray, " k"], before: int) -> Vector3:
    """Point at which the share passes the border's between a point and the next."""
    low, high = shares[before], shares[before + 1]
    along = (BORDER_SHARE - low) / (high - low)
    return points[before] + along * (points[before + 1] - points[before])


def hull_indices(points: Points2D) -> Integer[np.ndarray, " corners"]:
    """Indices of the corners of the convex hull, counter-clockwise."""
    return convex_hull(np.ascontiguousarray(points))


def closed_length(points: Float[np.ndarray, "k d"]) -> float:
    """Length of the closed polygon through the points."""
    return float(polygon_length(np.ascontiguousarray(points)))


def surrounds(hull: Points2D, point: Float[np.ndarray, "2"]) -> bool:
    """Whether a counter-clockwise convex polygon contains the point."""
    edges = np.roll(hull, -1, axis=0) - hull
    offsets = point - hull
    return bool(np.all(edges[:, 0] * offsets[:, 1] - edges[:, 1] * offsets[:, 0] >= 0.0))
