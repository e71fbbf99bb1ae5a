"""A part of a mesh as a mesh of its own."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Integer


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
