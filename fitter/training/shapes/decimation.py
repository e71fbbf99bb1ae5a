"""Mesh decimation: a closed surface with fewer vertices, all of them its own.

Half-edge collapses (Garland and Heckbert, "Surface simplification using quadric error metrics",
SIGGRAPH 1997, with the target placed on one of the two ends): a vertex moves onto a neighbour and
disappears, the cheapest first. What remains is a subset of the vertices, so that whatever is known
of a vertex, on any body of the same mesh, holds for the lighter surface too. Packages that decimate
place vertices anew and hold none.
"""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float, Integer

from fitter.arrays import Triangles, Vertices
from fitter.body.lighter_model import held_vertices
from fitter.body.model import LighterMesh, SparseRows
from fitter.training.shapes._decimation_kernels import collapse_independent

_MOST_ROUNDS = 40
_LEAST_SHARE = 1e-3
"""A round that removes a smaller share of the vertices is the last."""


LONGEST_M = 0.014
"""Edges of this length and more stay: trunk and limbs keep theirs, 16 to 32 mm."""

ERROR_M = 0.001
"""Largest move of the mean body's surface: a third of a pixel, or a fifth, of usual pictures."""


def lighter_mesh(
    mean_vertices: Vertices, triangles: Triangles, rows: Sequence[SparseRows]
) -> LighterMesh:
    """The lighter mesh of a model: the few vertices of a landmark or a joint stay."""
    held = held_vertices(rows, len(mean_vertices))
    return decimated(mean_vertices, triangles, held=held, longest=LONGEST_M, error=ERROR_M)


def decimated(
    vertices: Vertices,
    triangles: Triangles,
    *,
    held: Bool[np.ndarray, " m"],
    longest: float,
    error: float,
) -> LighterMesh:
    """Remove vertices along short edges as long as the surface hardly moves.

    Parameters
    ----------
    vertices, triangles
        A closed manifold surface.
    held
        (m,) vertices that must remain.
    longest
        Edges at least this long are not collapsed; in the unit of the vertices.
    error
        Largest root mean square distance from a vertex to the planes of all triangles it has come
        to stand for, weighted by area.
    """
    triangles = triangles.astype(np.int64)
    origin = np.arange(len(triangles))
    quadrics, areas = _quadrics(vertices, triangles)
    owners = np.arange(len(vertices))
    for _ in range(_MOST_ROUNDS):
        removed, onto = _candidates(vertices, triangles, quadrics, areas, held, longest, error)
        pointers, rings = _rings(triangles, len(vertices))
        now = np.arange(len(vertices))
        count = collapse_independent(vertices, triangles, pointers, rings, removed, onto, now)
        gone = np.flatnonzero(now != np.arange(len(now)))
        np.add.at(quadrics, now[gone], quadrics[gone])
        np.add.at(areas, now[gone], areas[gone])
        owners = now[owners]
        remain = triangles[:, 0] >= 0
        triangles, origin = triangles[remain], origin[remain]
        if count < _LEAST_SHARE * len(vertices):
            break
    kept = np.unique(triangles)
    place = np.full(len(vertices), -1)
    place[kept] = np.arange(len(kept))
    lighter = place[triangles].astype(np.int32)
    corners, shares = _nearest_on(vertices, kept, lighter, place[owners])
    return LighterMesh(kept=kept, triangles=lighter, origin=origin, corners=corners, shares=shares)


def _quadrics(
    vertices: Vertices, triangles: Triangles
) -> tuple[Float[np.ndarray, "m 4 4"], Float[np.ndarray, " m"]]:
    """Sums over the triangles around each vertex of area times (plane planeᵀ), and of area."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    doubled = np.linalg.norm(normals, axis=1)
    normals /= doubled[:, None]
    planes = np.column_stack([normals, -(normals * a).sum(axis=1)])
    quadrics, areas = np.zeros((len(vertices), 4, 4)), np.zeros(len(vertices))
    weighted = (0.5 * doubled)[:, None, None] * planes[:, :, None] * planes[:, None, :]
    for corner in range(3):
        np.add.at(quadrics, triangles[:, corner], weighted)
        np.add.at(areas, triangles[:, corner], 0.5 * doubled)
    return quadrics, areas


def _candidates(
    vertices: Vertices,
    triangles: Triangles,
    quadrics: Float[np.ndarray, "m 4 4"],
    areas: Float[np.ndarray, " m"],
    held: Bool[np.ndarray, " m"],
    longest: float,
    error: float,
) -> tuple[Integer[np.ndarray, " e"], Integer[np.ndarray, " e"]]:
    """Vertices that may go and what onto, the cheapest first."""
    # Every edge of a closed surface is run in both directions.
    removed = triangles.reshape(-1)
    onto = triangles[:, [1, 2, 0]].reshape(-1)
    length = np.linalg.norm(vertices[removed] - vertices[onto], axis=1)
    possible = ~held[removed] & (length < longest)
    removed, onto, length = removed[possible], onto[possible], length[possible]
    place = np.column_stack([vertices[onto], np.ones(len(onto))])
    squared = np.einsum("ki,kij,kj->k", place, quadrics[removed] + quadrics[onto], place)
    distance = np.sqrt(np.maximum(squared, 0.0) / (areas[removed] + areas[onto]))
    near = distance < error
    # Of equally flat ones the shorter first, so that the surface thins out evenly.
    order = np.lexsort([removed[near], (distance[near] + error) * length[near]])
    return removed[near][order], onto[near][order]


def _rings(
    triangles: Triangles, vertex_count: int
) -> tuple[Integer[np.ndarray, " m1"], Integer[np.ndarray, " r"]]:
    """The triangles around each vertex, CSR-like."""
    corners = triangles.reshape(-1)
    order = np.argsort(corners, kind="stable")
    counts = np.bincount(corners, minlength=vertex_count)
    return np.concatenate([[0], np.cumsum(counts)]), order // 3


def _nearest_on(
    vertices: Vertices,
    kept: Integer[np.ndarray, " k"],
    triangles: Triangles,
    owners: Integer[np.ndarray, " m"],
) -> tuple[Integer[np.ndarray, "m 3"], Float[np.ndarray, "m 3"]]:
    """The nearest of the triangles around each vertex' owner, and the place in it."""
    pointers, rings = _rings(triangles.astype(np.int64), len(kept))
    counts = np.diff(pointers)[owners]
    asking = np.repeat(np.arange(len(vertices)), counts)
    first = np.concatenate([[0], np.cumsum(counts)[:-1]])
    around = rings[np.repeat(pointers[owners] - first, counts) + np.arange(len(asking))]
    corners = triangles[around]
    shares = _barycentric(vertices[asking], vertices[kept[corners]])
    places = np.einsum("kc,kci->ki", shares, vertices[kept[corners]])
    distances = np.linalg.norm(places - vertices[asking], axis=1)
    order = np.lexsort([distances, asking])
    nearest = order[np.searchsorted(asking[order], np.arange(len(vertices)))]
    return corners[nearest], shares[nearest]


def _barycentric(
    points: Float[np.ndarray, "k 3"], corners: Float[np.ndarray, "k 3 3"]
) -> Float[np.ndarray, "k 3"]:
    """Coordinates of the points' projections, drawn in where they lie outside the triangle."""
    one, two = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    to = points - corners[:, 0]
    a, b, c = (one * one).sum(1), (one * two).sum(1), (two * two).sum(1)
    d, e = (to * one).sum(1), (to * two).sum(1)
    determinant = a * c - b * b
    u, v = (c * d - b * e) / determinant, (a * e - b * d) / determinant
    shares = np.maximum(np.stack([1.0 - u - v, u, v], axis=1), 0.0)
    return shares / shares.sum(axis=1, keepdims=True)
