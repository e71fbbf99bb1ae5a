"""Vertices that stand for a closed surface at an even density.

Meshes of people are ten times denser on head, hands and feet than on the trunk; a field over the
surface that is smooth at the trunk's scale needs no more points there than elsewhere.

It is the costly part of such a factorisation and does not depend on values: it is found once for a
mesh, and any part of the mesh keeps it.
"""

from dataclasses import dataclass
from heapq import heappop, heappush

import numpy as np
import qdldl
from jaxtyping import Float, Integer
from scipy import sparse

from fitter.arrays import PerVertex, Vertices


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SurfaceSample:
    """Some vertices of a mesh as a mesh of their own.

    Attributes
    ----------
    vertices
        (k,) which they are, ascending.
    edges
        (e, 2) into ``vertices``, the smaller first: those whose surroundings touch.
    areas
        (m,) the share of the surface each stands for, 0 for all others.
    elimination_ranks
        (k,) when each is eliminated from matrices of this mesh (:func:`elimination_order`).
    """

    vertices: Integer[np.ndarray, " k"]
    edges: Integer[np.ndarray, "e 2"]
    areas: PerVertex
    elimination_ranks: Integer[np.ndarray, " k"]


def surface_sample(
    vertices: Vertices, edges: Integer[np.ndarray, "e 2"], areas: PerVertex, *, spacing: float
) -> SurfaceSample:
    """Vertices no two of which are nearer than ``spacing`` along the mesh's edges.

    Parameters
    ----------
    vertices, edges
        The mesh; each edge once.
    areas
        Share of the surface of each vertex. The largest are chosen first.
    spacing
        In the unit of the vertices.
    """
    owners = _owners(vertices, edges, np.argsort(-areas, kind="stable"), spacing)
    chosen, place = np.unique(owners, return_inverse=True)
    ends = np.sort(place[edges], axis=1)
    shares = np.zeros(len(vertices))
    np.add.at(shares, owners, areas)
    between = np.unique(ends[ends[:, 0] < ends[:, 1]], axis=0)
    return SurfaceSample(
        vertices=chosen,
        edges=between,
        areas=shares / shares.sum(),
        elimination_ranks=np.argsort(elimination_order(between, len(chosen))),
    )


def _owners(
    vertices: Vertices,
    edges: Integer[np.ndarray, "e 2"],
    order: Integer[np.ndarray, " m"],
    spacing: float,
) -> Integer[np.ndarray, " m"]:
    """The chosen vertex nearest to each vertex, chosen in order where none is near yet."""
    neighbours = _neighbours(vertices, edges)
    owners = np.full(len(vertices), -1)
    nearest = np.full(len(vertices), np.inf)
    for centre in order.tolist():
        if owners[centre] >= 0:
            continue
        reached: set[int] = set()
        front = [(0.0, centre)]
        while front:
            distance, vertex = heappop(front)
            if vertex in reached:
                continue
            reached.add(vertex)
            if distance < nearest[vertex]:
                nearest[vertex], owners[vertex] = distance, centre
            for other, length in neighbours[vertex]:
                if distance + length < spacing and other not in reached:
                    heappush(front, (distance + length, other))
    return owners


def _neighbours(
    vertices: Vertices, edges: Integer[np.ndarray, "e 2"]
) -> list[list[tuple[int, float]]]:
    found: list[list[tuple[int, float]]] = [[] for _ in vertices]
    lengths: Float[np.ndarray, " e"] = np.linalg.norm(
        vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1
    )
    for (first, second), length in zip(edges.tolist(), lengths.tolist(), strict=True):
        found[first].append((second, length))
        found[second].append((first, length))
    return found


def elimination_order(edges: Integer[np.ndarray, "e 2"], count: int) -> Integer[np.ndarray, " m"]:
    """The vertices of a graph in an order in which a factor stays sparse (minimum degree)."""
    low, high = np.sort(edges, axis=1).T
    every = np.arange(count)
    degrees = np.bincount(edges.reshape(-1), minlength=count) + 1.0
    matrix = sparse.csc_matrix(
        (
            np.concatenate([degrees, np.full(len(edges), -1.0)]),
            (np.concatenate([every, low]), np.concatenate([every, high])),
        ),
        shape=(count, count),
    )
    _, _, order = qdldl.Solver(matrix, upper=True).factors()
    return np.asarray(order, dtype=np.int64)
