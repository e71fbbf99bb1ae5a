"""Area-weighted vertex normals, N(Θ_B) of section 5, and their derivatives."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Normals, Triangles, Vertices
from fitter.numerics._mesh_kernels import (
    accumulate_normals,
    pull_back_normals,
)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class VertexRings:
    """The triangles round each vertex (CSR)."""

    pointers: Integer[np.ndarray, " m1"]
    triangles: Integer[np.ndarray, " three_f"]


def vertex_rings(triangles: Triangles, vertex_count: int) -> VertexRings:
    """Triangles round each vertex."""
    corners = triangles.ravel()
    order = np.argsort(corners, kind="stable")
    counts = np.bincount(corners, minlength=vertex_count)
    return VertexRings(
        pointers=np.concatenate([[0], np.cumsum(counts)]).astype(np.int32),
        triangles=(order // 3).astype(np.int32),
    )


def summed_cross_products(vertices: Vertices, triangles: Triangles) -> Normals:
    """Twice the area-weighted sum of triangle normals at each vertex, not normalised."""
    result = np.empty_like(vertices)
    accumulate_normals(vertices, triangles, result)
    return result


def add_normal_derivative(
    vertices: Vertices,
    triangles: Triangles,
    rings: VertexRings,
    chosen: Integer[np.ndarray, " k"],
    by_normal: Float[np.ndarray, "k 3"],
    by_vertices: Vertices,
) -> None:
    """Add the derivative by vertices of a scalar known by its derivative by some unit normals.

    Parameters
    ----------
    vertices, triangles, rings
        The mesh, any frame.
    chosen, by_normal
        Vertices, and the derivative by their unit normals.
    by_vertices
        (m, 3) added to in place.
    """
    pull_back_normals(
        vertices, triangles, rings.pointers, rings.triangles, chosen, by_normal, by_vertices
    )
