"""Slices of a mesh and the tape around them.

Section 6: girths are "computed by transforming the body to a canonical pose, slicing the mesh on a
fixed plane and computing the convex hull of the contour", because a tape spans hollows.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Integer

from fitter.arrays import Points2D, Points3D, Triangles, Vector3, Vertices
from fitter.measurement._section_kernels import (
    convex_hull,
    flatten,
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
    members, vertices
        Ids of those triangles and of their corners, ascending.
    """

    triangles: Triangles
    neighbours: Integer[np.ndarray, "f 3"]
    allowed: Bool[np.ndarray, " f"]
    members: Integer[np.ndarray, " r"]
    vertices: Integer[np.ndarray, " c"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Polyline:
    """Where a plane cuts a region: a closed loop, or an open line ending at the region's border."""

    points: Points3D
    closed: bool


def whole_mesh(triangles: Triangles) -> Region:
    """The region of all triangles."""
    triangles = np.ascontiguousarray(triangles, dtype=np.int32)
    everything = np.ones(len(triangles), dtype=np.bool_)
    return _region(triangles, triangle_neighbours(triangles), everything)


def restricted(region: Region, allowed: Bool[np.ndarray, " f"]) -> Region:
    """The region's triangles that are also ``allowed``."""
    return _region(region.triangles, region.neighbours, region.allowed & allowed)


def _region(
    triangles: Triangles, neighbours: Integer[np.ndarray, "f 3"], allowed: Bool[np.ndarray, " f"]
) -> Region:
    return Region(
        triangles=triangles,
        neighbours=neighbours,
        allowed=allowed,
        members=np.flatnonzero(allowed),
        vertices=np.unique(triangles[allowed]),
    )


def plane_section(vertices: Vertices, region: Region, plane: Plane) -> tuple[Polyline, ...]:
    """Every polyline in which ``plane`` cuts ``region``, in the frame of ``vertices``."""
    points, starts, closed = trace_section(
        np.ascontiguousarray(vertices),
        region.triangles,
        region.neighbours,
        region.allowed,
        region.members,
        region.vertices,
        plane.point,
        plane.normal,
    )
    return tuple(
        Polyline(points=points[start:stop], closed=bool(is_closed))
        for start, stop, is_closed in zip(starts[:-1], starts[1:], closed, strict=True)
    )


def in_plane(points: Points3D, plane: Plane) -> Points2D:
    """Coordinates of points along two orthonormal directions of the plane."""
    return flatten(np.ascontiguousarray(points), plane.point, plane.normal)


def hull_of(points: Points2D) -> Points2D:
    """Corners of the convex hull, counter-clockwise."""
    return points[convex_hull(np.ascontiguousarray(points))]


def closed_length(points: Float[np.ndarray, "k d"]) -> float:
    """Length of the closed polygon through the points."""
    return float(polygon_length(np.ascontiguousarray(points)))


def surrounds(hull: Points2D, point: Float[np.ndarray, "2"]) -> bool:
    """Whether a counter-clockwise convex polygon contains the point."""
    edges = np.roll(hull, -1, axis=0) - hull
    offsets = point - hull
    return bool(np.all(edges[:, 0] * offsets[:, 1] - edges[:, 1] * offsets[:, 0] >= 0.0))
