"""Where a closed mesh runs through itself."""

import numpy as np
from jaxtyping import Bool, Integer

from fitter.arrays import Triangles, Vertices
from fitter.numerics._self_crossing_kernels import grid_of_triangles, mark_pierced

_CELLS_ALONG_LONGEST = 160
"""Of the grid that brings edges and triangles together. A body takes 0.16 s with 128 to 200, 0.3 s
with 64 or 300: two thirds of its triangles are those of head, hands and feet."""


def pierced_triangles(
    vertices: Vertices, triangles: Triangles, edges: Integer[np.ndarray, "e 2"]
) -> Bool[np.ndarray, " f"]:
    """Which triangles an edge of the same mesh runs through.

    Edges and triangles that share a corner do not count: they always touch. Of two surfaces that
    cross, every crossing of two triangles has an edge of one that runs through the other.

    Parameters
    ----------
    vertices, triangles
        The mesh.
    edges
        Its undirected edges (:func:`fitter.numerics.mesh_topology.mesh_topology`).
    """
    vertices = np.ascontiguousarray(vertices, dtype=np.float64)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    cell = float((high - low).max()) / _CELLS_ALONG_LONGEST
    counts = np.floor((high - low) / cell).astype(np.int64) + 1
    pointers, members = grid_of_triangles(vertices, triangles, low, cell, counts)
    pierced = np.zeros(len(triangles), dtype=np.bool_)
    mark_pierced(vertices, triangles, edges, pointers, members, low, cell, counts, pierced)
    return pierced
