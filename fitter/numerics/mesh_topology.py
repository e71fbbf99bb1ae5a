"""Which edges, triangles and vertices of a mesh touch; computed once per mesh."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Integer

from fitter.arrays import Triangles


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
    neighbour_pointers, neighbours
        The vertices joined to vertex i by an edge, N(i) in Eq. 2, ascending:
        ``neighbours[neighbour_pointers[i] : neighbour_pointers[i + 1]]``.
    """

    edges: Integer[np.ndarray, "e 2"]
    edge_triangles: Integer[np.ndarray, "e 2"]
    neighbour_pointers: Integer[np.ndarray, " m1"]
    neighbours: Integer[np.ndarray, " two_e"]


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
    both_ways = np.concatenate([edges, edges[:, ::-1]])
    both_ways = both_ways[np.lexsort((both_ways[:, 1], both_ways[:, 0]))]
    counts = np.bincount(both_ways[:, 0], minlength=vertex_count)
    return MeshTopology(
        edges=edges,
        edge_triangles=edge_triangles,
        neighbour_pointers=np.concatenate([[0], np.cumsum(counts)]).astype(np.int32),
        neighbours=np.ascontiguousarray(both_ways[:, 1]),
    )


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
