"""A body on a mesh four times as fine: every edge halved where a smooth skin would run."""

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Triangles, Vertices
from fitter.numerics.mesh_topology import mesh_topology
from fitter.numerics.normals import summed_cross_products


def halved_edges(triangles: Triangles, vertex_count: int) -> Integer[np.ndarray, "e 2"]:
    """The edges of a closed mesh, in the order of the vertices that halve them."""
    return mesh_topology(triangles, vertex_count=vertex_count).edges


def refined_triangles(triangles: Triangles, vertex_count: int) -> Integer[np.ndarray, "4*f 3"]:
    """Each triangle cut into four, kept together and in order; new vertices after the old ones."""
    edges = halved_edges(triangles, vertex_count)
    keys = edges[:, 0].astype(np.int64) * vertex_count + edges[:, 1]
    pairs = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2), axis=2)
    wanted = pairs[..., 0].astype(np.int64) * vertex_count + pairs[..., 1]
    # middles[:, k] halves the edge from corner k to corner k + 1.
    middles = vertex_count + np.searchsorted(keys, wanted)
    a, b, c = triangles.T
    ab, bc, ca = middles.T
    four = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return np.stack([np.stack(corners, axis=1) for corners in four], axis=1).reshape(-1, 3)


def flat_refinement(
    values: Float[np.ndarray, "m d"], edges: Integer[np.ndarray, "e 2"]
) -> Float[np.ndarray, "m+e d"]:
    """The same surface, or values on it, with more vertices: edges halved where they run."""
    return np.concatenate([values, values[edges].mean(axis=1)])


def smooth_refinement(
    vertices: Vertices, triangles: Triangles, edges: Integer[np.ndarray, "e 2"]
) -> Float[np.ndarray, "m+e 3"]:
    """Edges halved on the smooth curve that leaves both ends along their tangent planes.

    The cubic Hermite curve from a to b, whose tangents are b - a laid into the planes of the vertex
    normals, has its middle at (a + b) / 2 + (t_a - t_b) / 8. Old vertices stay: unlike Loop's
    scheme this one interpolates, and the change is what flat triangles leave out, not a shrinking.
    """
    normals = summed_cross_products(vertices, triangles)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    start, end = edges.T
    along = vertices[end] - vertices[start]
    tangent_change = -normals[start] * np.einsum("ei,ei->e", normals[start], along)[:, None]
    tangent_change += normals[end] * np.einsum("ei,ei->e", normals[end], along)[:, None]
    return np.concatenate([vertices, vertices[edges].mean(axis=1) + tangent_change / 8.0])
