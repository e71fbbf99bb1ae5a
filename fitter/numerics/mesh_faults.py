"""Faults that keep a triangle mesh from being the skin of a body, in words a user can act on."""

import numpy as np
from jaxtyping import Bool, Integer
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from fitter.arrays import Triangles, Vertices
from fitter.numerics._self_crossing_kernels import grid_of_triangles, mark_pierced

LEAST_AREA_RATIO = 1e-9
"""A triangle smaller than this share of the mean one has no plane of its own: its deformation
gradient would be noise, or none."""


def closed_surface_fault(triangles: Triangles, *, vertex_count: int) -> str | None:
    """Why triangles are not one closed, manifold, consistently oriented sphere; None if they are.

    Indices must be within ``vertex_count``. The sentence begins in the middle and ends without a
    full stop: the caller puts the name before it and the remedy after it.
    """
    twice = (triangles == np.roll(triangles, -1, axis=1)).any(axis=1)
    if twice.any():
        first = int(np.argmax(twice))
        return f"has triangles with a corner twice, the first is {first}: {triangles[first]}"
    idle = np.flatnonzero(np.bincount(triangles.reshape(-1), minlength=vertex_count) == 0)
    if len(idle):
        return f"leaves {len(idle)} vertices without a triangle, the first is {idle[0]}"
    return _edge_fault(triangles, vertex_count) or _form_fault(triangles, vertex_count)


def solid_fault(vertices: Vertices, triangles: Triangles) -> str | None:
    """Why a closed surface encloses nothing: triangles without area, or turned inside out."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    areas = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    collapsed = np.flatnonzero(areas <= LEAST_AREA_RATIO * areas.mean())
    if len(collapsed):
        return f"gives {len(collapsed)} triangles no area, the first is {collapsed[0]}"
    if np.einsum("fi,fi->", a, np.cross(b, c)) <= 0.0:
        return (
            "turns the triangles inside out, expected corners that run counter-clockwise seen from "
            "outside"
        )
    return None


def _edge_fault(triangles: Triangles, vertex_count: int) -> str | None:
    starts = triangles.reshape(-1).astype(np.int64)
    ends = np.roll(triangles, -1, axis=1).reshape(-1).astype(np.int64)
    keys = np.minimum(starts, ends) * vertex_count + np.maximum(starts, ends)
    order = np.argsort(keys, kind="stable")
    begins = np.flatnonzero(np.diff(keys[order], prepend=-1))
    counts = np.diff(begins, append=len(keys))
    if (counts == 1).any():
        edge = _edge(int(keys[order][begins[np.argmax(counts == 1)]]), vertex_count)
        count = np.count_nonzero(counts == 1)
        return f"has a hole: {count} edges have one triangle only, the first is {edge}"
    if (counts > 2).any():
        edge = _edge(int(keys[order][begins[np.argmax(counts > 2)]]), vertex_count)
        count = np.count_nonzero(counts > 2)
        return f"is not manifold: {count} edges have more than two triangles, the first is {edge}"
    forward = (starts < ends)[order]
    alike = forward[begins] == forward[begins + 1]
    if alike.any():
        edge = _edge(int(keys[order][begins[np.argmax(alike)]]), vertex_count)
        return (
            f"is not oriented alike: the two triangles of {np.count_nonzero(alike)} edges run them "
            f"the same way, the first is {edge}"
        )
    return None


def _form_fault(triangles: Triangles, vertex_count: int) -> str | None:
    starts, ends = triangles.reshape(-1), np.roll(triangles, -1, axis=1).reshape(-1)
    links = sparse.coo_array((np.ones(len(starts)), (starts, ends)), shape=(vertex_count,) * 2)
    pieces, _ = connected_components(links, directed=False)
    if pieces > 1:
        return f"falls into {pieces} pieces"
    # A closed surface has three halves of an edge a triangle.
    characteristic = vertex_count - 3 * len(triangles) // 2 + len(triangles)
    if characteristic != 2:
        return (
            f"is no sphere (Euler characteristic {characteristic}, not 2): it has handles, "
            "as where fingers are fused, or touches itself in a vertex"
        )
    return None


def _edge(key: int, vertex_count: int) -> str:
    return f"({key // vertex_count}, {key % vertex_count})"


_CELLS_ALONG_LONGEST = 160
"""Cells along the grid that brings edges and triangles together. A body takes 0.16 s with 128 to
200, 0.3 s with 64 or 300: two thirds of its triangles are those of head, hands and feet."""


def pierced_triangles(
    vertices: Vertices, triangles: Triangles, edges: Integer[np.ndarray, "e 2"]
) -> Bool[np.ndarray, " f"]:
    """Whether an edge of the same mesh runs through each triangle.

    Edges and triangles that share a corner do not count: they always touch. Of two surfaces that
    cross, every crossing of two triangles has an edge of one that runs through the other.

    Parameters
    ----------
    vertices, triangles
        The mesh.
    edges
        Its undirected edges (:func:`fitter.numerics.meshes.mesh_topology`).
    """
    vertices = np.ascontiguousarray(vertices, dtype=np.float64)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    cell = float((high - low).max()) / _CELLS_ALONG_LONGEST
    counts = np.floor((high - low) / cell).astype(np.int64) + 1
    pointers, members = grid_of_triangles(vertices, triangles, low, cell, counts)
    pierced = np.zeros(len(triangles), dtype=np.bool_)
    mark_pierced(vertices, triangles, edges, pointers, members, low, cell, counts, pierced)
    return pierced
