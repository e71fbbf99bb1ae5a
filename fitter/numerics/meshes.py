"""Closed triangle meshes: connectivity, areas, volume, vertex normals and deformation gradients.

Normals are weighted by area, N(Θ_B) of section 5, and have derivatives. Connectivity is computed
once a mesh.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Integer
from scipy import sparse

from fitter.arrays import Normals, PerTriangle, PerVertex, Triangles, Vertices
from fitter.numerics._mesh_kernels import (
    accumulate_normals,
    pull_back_normals,
    sum_of_tetrahedra,
    tetrahedra_gradient,
)


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


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MeshTopology:
    """Connectivity of a closed, consistently oriented triangle mesh.

    Attributes
    ----------
    edges
        (e, 2) vertex ids of each undirected edge, the smaller first, in lexicographic order.
    edge_triangles
        (e, 2) the two triangles of an edge: first the one that runs it from the smaller vertex to
        the larger, then the one that runs it back.
    """

    edges: Integer[np.ndarray, "e 2"]
    edge_triangles: Integer[np.ndarray, "e 2"]


def mesh_topology(triangles: Triangles, *, vertex_count: int) -> MeshTopology:
    """Connectivity of a closed mesh of ``vertex_count`` vertices.

    Raises
    ------
    ValueError
        If an edge has not exactly two triangles that run it in opposite directions.
    """
    starts = triangles.reshape(-1).astype(np.int64)
    ends = np.roll(triangles, -1, axis=1).reshape(-1).astype(np.int64)
    owner = np.repeat(np.arange(len(triangles), dtype=np.int32), 3)
    forward = starts < ends
    forward_keys = starts[forward] * vertex_count + ends[forward]
    backward_keys = ends[~forward] * vertex_count + starts[~forward]
    forward_order = np.argsort(forward_keys)
    backward_order = np.argsort(backward_keys)
    keys = forward_keys[forward_order]
    if not np.array_equal(keys, backward_keys[backward_order]) or (np.diff(keys) == 0).any():
        message = "The mesh is not closed, manifold and consistently oriented."
        raise ValueError(message)
    edges = np.stack([keys // vertex_count, keys % vertex_count], axis=1).astype(np.int32)
    edge_triangles = np.stack(
        [owner[forward][forward_order], owner[~forward][backward_order]], axis=1
    )
    return MeshTopology(edges=edges, edge_triangles=edge_triangles)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MeshPart:
    """Some vertices of a mesh with the edges between them.

    Attributes
    ----------
    members
        (m,) whether a vertex of the mesh belongs to the part.
    vertices
        (k,) which they are.
    edges
        (f, 2) into ``vertices``.
    edge_ids
        (f,) which edges of the mesh they are.
    """

    members: Bool[np.ndarray, " m"]
    vertices: Integer[np.ndarray, " k"]
    edges: Integer[np.ndarray, "f 2"]
    edge_ids: Integer[np.ndarray, " f"]


def mesh_part(members: Bool[np.ndarray, " m"], edges: Integer[np.ndarray, "e 2"]) -> MeshPart:
    """The part of a mesh that some of its vertices span."""
    vertices = np.flatnonzero(members)
    place = np.full(len(members), -1)
    place[vertices] = np.arange(len(vertices))
    edge_ids = np.flatnonzero(members[edges].all(axis=1))
    return MeshPart(
        members=members, vertices=vertices, edges=place[edges[edge_ids]], edge_ids=edge_ids
    )


def grown(
    members: Bool[np.ndarray, " m"], edges: Integer[np.ndarray, "e 2"], rings: int
) -> Bool[np.ndarray, " m"]:
    """Some vertices and all within so many edges of them."""
    result = members.copy()
    first, second = edges.T
    for _ in range(rings):
        touched = result[first] | result[second]
        result[first[touched]] = True
        result[second[touched]] = True
    return result


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


def gradient_operator(rest: Vertices, triangles: Triangles) -> sparse.csr_array:
    """The in-plane gradient of a function on vertices, two rows a triangle.

    For triangle t with an orthonormal frame (u, v) in its rest plane, rows 2t and 2t + 1 give the
    derivatives along u and v of the linear interpolation of the vertex values. Applied to the
    coordinates of a deformed mesh they are the columns of its deformation gradient that a
    triangle can know; SCAPE's edges carry the same information.

    Returns
    -------
    Sparse (2 f, m).
    """
    a, b, c = (rest[triangles[:, k]] for k in range(3))
    first, second = b - a, c - a
    u = first / np.linalg.norm(first, axis=1, keepdims=True)
    normal = np.cross(first, second)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    v = np.cross(normal, u)
    planar = np.empty((len(triangles), 2, 2))  # edge vectors in the frame, as rows
    planar[:, 0, 0], planar[:, 0, 1] = (first * u).sum(1), (first * v).sum(1)
    planar[:, 1, 0], planar[:, 1, 1] = (second * u).sum(1), (second * v).sum(1)
    inverse = np.linalg.inv(planar)  # gradient = inverse @ (y_b - y_a, y_c - y_a)
    coefficients = np.stack(
        [-inverse.sum(axis=2), inverse[:, :, 0], inverse[:, :, 1]], axis=2
    )  # (f, 2 directions, 3 corners)
    rows = np.repeat(np.arange(2 * len(triangles)), 3)
    columns = np.repeat(triangles, 2, axis=0).reshape(-1)
    return sparse.csr_array(
        (coefficients.reshape(-1), (rows, columns)), shape=(2 * len(triangles), len(rest))
    )


def weighted_laplacian(
    gradient: sparse.csr_array, triangle_weights: PerTriangle
) -> sparse.csr_array:
    """Gᵀ W G: with areas as weights, the cotangent Laplacian. Rows sum to zero."""
    weights = sparse.diags_array(np.repeat(triangle_weights, 2))
    return sparse.csr_array(gradient.T @ weights @ gradient)


def part_laplacians(
    gradient: sparse.csr_array,
    triangle_weights: PerTriangle,
    part_of_triangle: Integer[np.ndarray, " f"],
    part_count: int,
) -> list[sparse.csr_array]:
    """The Laplacian restricted to each part's triangles; they sum to the whole."""
    return [
        weighted_laplacian(gradient, np.where(part_of_triangle == part, triangle_weights, 0.0))
        for part in range(part_count)
    ]
