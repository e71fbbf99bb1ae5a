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


AREA_SHARE = 0.75
"""Share of a vertex's mass that is its area; the rest is alike for all. On 60 held-out women the
mean error at n = 20 is 3.45 mm by vertex and 3.50 by area with areas alone, 3.02 and 3.58 with this
share, 2.78 and 3.69 with a half: faces and hands, where most vertices lie, come almost free."""


def vertex_masses(vertices: Vertices, triangles: Triangles) -> PerVertex:
    """Weights of the metric of shapes, summing to one."""
    areas = vertex_areas(vertices, triangles)
    return AREA_SHARE * areas / areas.sum() + (1.0 - AREA_SHARE) / len(areas)
