"""Closed triangle meshes: adjacency, areas and volume."""

import numpy as np
from jaxtyping import Integer

from fitter.arrays import PerTriangle, PerVertex, Triangles, Vertices
from fitter.numerics._mesh_kernels import sum_of_tetrahedra, tetrahedra_gradient


def triangle_neighbours(triangles: Triangles) -> Integer[np.ndarray, "f 3"]:
    """The triangle across each edge, -1 at a border; edge k runs from corner k to corner k + 1."""
    starts = triangles.ravel()
    ends = np.roll(triangles, -1, axis=1).ravel()
    low, high = np.minimum(starts, ends), np.maximum(starts, ends)
    order = np.lexsort((high, low))
    same = (np.diff(low[order]) == 0) & (np.diff(high[order]) == 0)
    first, second = order[:-1][same], order[1:][same]
    neighbours = np.full(triangles.size, -1, dtype=np.int32)
    neighbours[first] = second // 3
    neighbours[second] = first // 3
    return neighbours.reshape(-1, 3)


def enclosed_volume(vertices: Vertices, triangles: Triangles) -> float:
    """Volume inside a closed mesh, cubic metres, by signed tetrahedra (divergence theorem).

    Positive where triangles run counter-clockwise seen from outside.
    """
    return float(sum_of_tetrahedra(np.ascontiguousarray(vertices, dtype=np.float64), triangles))


def volume_gradient(vertices: Vertices, triangles: Triangles) -> Vertices:
    """Derivative (m, 3) of :func:`enclosed_volume` by the vertices of a closed mesh."""
    return tetrahedra_gradient(np.ascontiguousarray(vertices, dtype=np.float64), triangles)


def triangle_areas(vertices: Vertices, triangles: Triangles) -> PerTriangle:
    """Area of every triangle, square metres."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)


def vertex_areas(vertices: Vertices, triangles: Triangles) -> PerVertex:
    """A third of the area of the triangles about each vertex; they sum to the surface."""
    shares = np.repeat(triangle_areas(vertices, triangles) / 3.0, 3)
    return np.bincount(triangles.reshape(-1), weights=shares, minlength=len(vertices))
