"""Shortest ways over a mesh, held to the edges they cross: geodesic lengths as smooth functions.

Section 4 names geodesic distances among the attributes that can be measured on the mesh. A way is
found once, on one body, as the places where it crosses edges; on any other body of the same mesh
the same crossings give its length. Around the body where it was found that is the geodesic to
first order, because a shortest way does not change its length when its crossings move a little.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer
from scipy import sparse
from scipy.optimize import minimize
from scipy.sparse.csgraph import dijkstra

from fitter.arrays import Points3D, Triangles, Vertices

COARSE_STATIONS = 2
FINE_STATIONS = 12
"""Places on every edge, besides its ends, that a way may step on: first over the whole mesh, then
over the triangles about the way found."""

NEIGHBOUR_RINGS = 2
"""Rings of triangles about the first way that the second may use."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SurfacePath:
    """A way over the surface.

    Crossing k lies at ``(1 - share[k]) vertices[edges[k, 0]] + share[k] vertices[edges[k, 1]]``;
    both ends are vertices, and consecutive crossings lie on one triangle.
    """

    edges: Integer[np.ndarray, "k 2"]
    share: Float[np.ndarray, " k"]

    def points(self, vertices: Vertices) -> Points3D:
        """Positions of the crossings."""
        first, second = vertices[self.edges[:, 0]], vertices[self.edges[:, 1]]
        return first + self.share[:, None] * (second - first)

    def length_m(self, vertices: Vertices) -> float:
        """Length of the way over a body, metres."""
        return float(np.linalg.norm(np.diff(self.points(vertices), axis=0), axis=1).sum())


def shortest_path(vertices: Vertices, triangles: Triangles, start: int, end: int) -> SurfacePath:
    """The shortest way between two vertices of a connected mesh.

    Dijkstra's search over stations on the edges, again with more stations near the way found, then
    straightening: the length is a convex function of where a way crosses the edges it crosses, and
    is minimised over these places.
    """
    coarse = _searched(vertices, triangles, start, end, COARSE_STATIONS)
    near = np.zeros(len(vertices), dtype=np.bool_)
    near[coarse.edges] = True
    for _ in range(NEIGHBOUR_RINGS):
        near[triangles[near[triangles].any(axis=1)]] = True
    about = triangles[near[triangles].all(axis=1)]
    return _straightened(_searched(vertices, about, start, end, FINE_STATIONS), vertices)


def _searched(
    vertices: Vertices, triangles: Triangles, start: int, end: int, stations: int
) -> SurfacePath:
    """The shortest way that bends at stations only."""
    edges, share, triangle_stations = _stations(triangles, len(vertices), stations)
    positions = vertices[edges[:, 0]] + share[:, None] * (
        vertices[edges[:, 1]] - vertices[edges[:, 0]]
    )
    graph = _station_graph(positions, triangle_stations)
    _, before = dijkstra(graph, directed=False, indices=start, return_predecessors=True)
    visited = [end]
    while visited[-1] != start:
        visited.append(int(before[visited[-1]]))
    chosen = np.array(visited[::-1])
    return SurfacePath(edges=edges[chosen], share=share[chosen])


def _stations(
    triangles: Triangles, vertex_count: int, count: int
) -> tuple[Integer[np.ndarray, "q 2"], Float[np.ndarray, " q"], Integer[np.ndarray, "f c"]]:
    """Edge and share of every station, vertices first, and the stations round each triangle."""
    pairs = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)
    edges, edge_of_side = np.unique(np.sort(pairs, axis=1), axis=0, return_inverse=True)
    inner = np.arange(1, count + 1) / (count + 1)
    own = np.arange(vertex_count)
    station_edges = np.concatenate([np.stack([own, own], axis=1), np.repeat(edges, count, axis=0)])
    share = np.concatenate([np.zeros(vertex_count), np.tile(inner, len(edges))])
    first = vertex_count + count * edge_of_side.reshape(-1, 3)
    on_sides = (first[:, :, None] + np.arange(count)).reshape(len(triangles), -1)
    return station_edges, share, np.concatenate([triangles, on_sides], axis=1)


def _station_graph(
    positions: Points3D, triangle_stations: Integer[np.ndarray, "f c"]
) -> sparse.csr_array:
    """Straight distances between all stations of each triangle."""
    one, other = np.triu_indices(triangle_stations.shape[1], k=1)
    ends = triangle_stations[:, one].ravel(), triangle_stations[:, other].ravel()
    count = len(positions)
    # Stations of an edge meet in both its triangles, and entries given twice would be added up.
    pairs = np.unique(np.minimum(*ends).astype(np.int64) * count + np.maximum(*ends))
    first, second = pairs // count, pairs % count
    lengths = np.linalg.norm(positions[first] - positions[second], axis=1)
    return sparse.csr_array((lengths, (first, second)), shape=(count, count))


def _straightened(path: SurfacePath, vertices: Vertices) -> SurfacePath:
    """The same crossings slid along their edges until the way is shortest."""
    along = vertices[path.edges[:, 1]] - vertices[path.edges[:, 0]]

    def length_and_slope(share: Float[np.ndarray, " k"]) -> tuple[float, Float[np.ndarray, " k"]]:
        steps = np.diff(SurfacePath(edges=path.edges, share=share).points(vertices), axis=0)
        lengths = np.linalg.norm(steps, axis=1)
        pulls = steps / np.maximum(lengths, 1e-12)[:, None]
        by_point = np.zeros_like(along)
        by_point[1:] += pulls
        by_point[:-1] -= pulls
        return float(lengths.sum()), np.einsum("ki,ki->k", by_point, along)

    found = minimize(
        length_and_slope,
        path.share,
        jac=True,
        method="L-BFGS-B",
        bounds=[(0.0, 1.0)] * len(path.share),
        options={"ftol": 1e-12, "gtol": 1e-10, "maxiter": 500},
    )
    return SurfacePath(edges=path.edges, share=found.x)
