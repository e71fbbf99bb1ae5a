"""Area-weighted vertex normals, N(Θ_B) of section 5, and their derivatives."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Normals, Triangles, Vertices
from fitter.numerics._normal_kernels import (
    accumulate_normals,
    change_of_normals,
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


def normal_derivative_to_vertices(
    vertices: Vertices, triangles: Triangles, normal_derivative: Normals
) -> Vertices:
    """Derivative by vertices of a scalar known by its derivative by unit vertex normals.

    Parameters
    ----------
    vertices, triangles
        The mesh, any frame.
    normal_derivative
        (m, 3) derivative by the unit normals; zero where a normal plays no part.
    """
    sums = summed_cross_products(vertices, triangles)
    length = np.linalg.norm(sums, axis=1, keepdims=True)
    length = np.where(length > 0.0, length, 1.0)
    unit = sums / length
    along = np.einsum("mi,mi->m", unit, normal_derivative)[:, None]
    pull = (normal_derivative - along * unit) / length
    result = np.empty_like(vertices)
    pull_back_normals(vertices, triangles, pull, result)
    return result


def normal_change(
    vertices: Vertices,
    triangles: Triangles,
    rings: VertexRings,
    chosen: Integer[np.ndarray, " k"],
    moves: Float[np.ndarray, "n m 3"],
) -> Float[np.ndarray, "k n 3"]:
    """Change of chosen unit normals per unit of each of n fields of vertex motion."""
    raw = np.empty((len(chosen), len(moves), 3))
    change_of_normals(vertices, triangles, rings.pointers, rings.triangles, chosen, moves, raw)
    sums = summed_cross_products(vertices, triangles)[chosen]
    length = np.linalg.norm(sums, axis=1, keepdims=True)
    length = np.where(length > 0.0, length, 1.0)
    unit = sums / length
    along = np.einsum("ki,kni->kn", unit, raw)
    return (raw - along[:, :, None] * unit[:, None, :]) / length[:, :, None]
