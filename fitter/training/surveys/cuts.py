"""Girths of a body at rest as fixed edge crossings of a plane cut's convex hull.

A tape spans hollows (section 6), so a girth is the length of the convex hull of a cut. Holding the
hull's corners to their places on mesh edges makes the girth a smooth function of the vertices; the
corners are found anew when the body has changed much.
"""

from dataclasses import dataclass
from typing import no_type_check

import numpy as np
from jaxtyping import Float, Integer
from numba import njit
from scipy import sparse
from scipy.sparse.csgraph import connected_components
from scipy.spatial import ConvexHull

from fitter.arrays import Triangles, Vector3, Vertices
from fitter.errors import NumericalError


@no_type_check
@njit(cache=True)
def crossed_triangles(side, triangles):
    """Triangles with corners on both sides; a corner at zero counts as above."""
    found = np.empty(len(triangles), np.int64)
    count = 0
    for triangle in range(len(triangles)):
        first, second, third = triangles[triangle]
        above = side[first] >= 0.0
        if (side[second] >= 0.0) != above or (side[third] >= 0.0) != above:
            found[count] = triangle
            count += 1
    return found[:count]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HullCut:
    """Corners of the hull of one cut, in order around it.

    Corner k lies at ``(1 - share[k]) vertices[edges[k, 0]] + share[k] vertices[edges[k, 1]]``.
    """

    edges: Integer[np.ndarray, "c 2"]
    share: Float[np.ndarray, " c"]

    def corners(self, vertices: Vertices) -> Float[np.ndarray, "c 3"]:
        """Positions of the corners."""
        first, second = vertices[self.edges[:, 0]], vertices[self.edges[:, 1]]
        return first + self.share[:, None] * (second - first)

    def girth(self, vertices: Vertices) -> float:
        """Length of the closed polygon through the corners."""
        corners = self.corners(vertices)
        return float(np.linalg.norm(corners - np.roll(corners, -1, axis=0), axis=1).sum())


def limb_cut(vertices: Vertices, triangles: Triangles, point: Vector3, normal: Vector3) -> HullCut:
    """Cut a mesh and take the hull of the loop around ``point``, or else of the one nearest to it.

    Raises
    ------
    NumericalError
        If the plane misses the mesh.
    """
    crossing = _crossing(vertices, triangles, point, normal)
    loops = range(int(crossing.loop.max()) + 1)
    chosen = min(loops, key=lambda loop: _remoteness(crossing.planar[crossing.loop == loop]))
    return _hull(crossing, np.flatnonzero(crossing.loop == chosen))


def trunk_cut(vertices: Vertices, triangles: Triangles, point: Vector3, normal: Vector3) -> HullCut:
    """Cut a mesh and take the hull of all that is cut.

    Of front and back where the armpits part them, of both thighs below the crotch. ``triangles``
    leave out what the tape does not go around.

    Raises
    ------
    NumericalError
        If the plane misses the mesh.
    """
    crossing = _crossing(vertices, triangles, point, normal)
    return _hull(crossing, np.arange(len(crossing.edges)))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Crossing:
    """Edges that a plane crosses, where (``share``, and in the plane), and the loop they are of."""

    edges: Integer[np.ndarray, "e 2"]
    share: Float[np.ndarray, " e"]
    planar: Float[np.ndarray, "e 2"]
    loop: Integer[np.ndarray, " e"]


def _crossing(
    vertices: Vertices, triangles: Triangles, point: Vector3, normal: Vector3
) -> _Crossing:
    side = (vertices - point) @ normal
    # A vertex on the plane would make degenerate edges; it counts as above.
    above = side >= 0.0
    crossed = triangles[crossed_triangles(side, triangles)]
    if not len(crossed):
        message = "a girth's plane misses the body"
        raise NumericalError(message)
    pairs = np.stack([crossed, np.roll(crossed, -1, axis=1)], axis=2)
    cut = above[pairs[..., 0]] != above[pairs[..., 1]]
    # Every crossed triangle has two crossed edges, and they connect in the loop.
    low, high = np.sort(pairs[cut], axis=1).T.astype(np.int64)
    keys, position = np.unique(low * len(vertices) + high, return_inverse=True)
    edges = np.stack(np.divmod(keys, len(vertices)), axis=1)
    links = position.reshape(-1, 2)
    graph = sparse.coo_array((np.ones(len(links)), (links[:, 0], links[:, 1])), (len(edges),) * 2)
    _, loop = connected_components(graph, directed=False)
    distance = np.abs(side[edges])
    share = distance[:, 0] / distance.sum(axis=1)
    positions = vertices[edges[:, 0]] + share[:, None] * np.diff(vertices[edges], axis=1)[:, 0]
    planar = (positions - point) @ _plane_axes(normal)
    return _Crossing(edges=edges, share=share, planar=planar, loop=loop)


def _hull(crossing: _Crossing, members: Integer[np.ndarray, " k"]) -> HullCut:
    corners = members[ConvexHull(crossing.planar[members]).vertices]
    return HullCut(edges=crossing.edges[corners], share=crossing.share[corners])


def _remoteness(loop: Float[np.ndarray, "k 2"]) -> tuple[bool, float]:
    """Whether the origin lies outside the loop's bounding box, and how far its middle is."""
    low, high = loop.min(axis=0), loop.max(axis=0)
    return bool((low > 0.0).any() or (high < 0.0).any()), float(np.linalg.norm(low + high))


def _plane_axes(normal: Vector3) -> Float[np.ndarray, "3 2"]:
    smallest = int(np.argmin(np.abs(normal)))
    first = np.cross(normal, np.eye(3)[smallest])
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(normal, first)], axis=1)
