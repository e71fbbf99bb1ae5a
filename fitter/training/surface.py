"""Areas of a triangle mesh and its vertices."""

import numpy as np

from fitter.arrays import PerTriangle, PerVertex, Triangles, Vertices


def triangle_areas(vertices: Vertices, triangles: Triangles) -> PerTriangle:
    """Area of every triangle, square metres."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)


def vertex_areas(vertices: Vertices, triangles: Triangles) -> PerVertex:
    """A third of the area of the triangles about each vertex; they sum to the surface."""
    shares = np.repeat(triangle_areas(vertices, triangles) / 3.0, 3)
    return np.bincount(triangles.reshape(-1), weights=shares, minlength=len(vertices))
