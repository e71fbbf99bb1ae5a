"""Breadth and depth of a trunk at level sections of a body at rest, on any mesh."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from fitter.arrays import Triangles, Vertices

LEVELS = tuple(round(0.48 + 0.03 * number, 2) for number in range(9))
"""Heights as shares of the body's own, from the floor: from the crotch (0.48) over the seat (0.51),
the navel (0.60) and the waist (0.63) to the chest (0.72). Heavy upper arms of the canonical pose
join the trunk from 0.73 on."""

NEAR_MIDDLE_M = 0.05
"""A loop of the trunk comes this near to the body's middle plane, an arm's does not. Between thin
thighs, whose loops are two, the gap is a centimetre or two."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TrunkSections:
    """Extents at :data:`LEVELS` along the body's left-right and front-back axes, metres."""

    breadth_m: Float[np.ndarray, " levels"]
    depth_m: Float[np.ndarray, " levels"]

    def __sub__(self, other: "TrunkSections") -> "TrunkSections":
        return TrunkSections(
            breadth_m=self.breadth_m - other.breadth_m, depth_m=self.depth_m - other.depth_m
        )


def trunk_sections(body: Vertices, triangles: Triangles) -> TrunkSections:
    """Cut a body that stands at rest, y up, arms off the trunk, its middle at x = 0."""
    low, high = float(body[:, 1].min()), float(body[:, 1].max())
    extents = [_trunk_extent(body, triangles, low + share * (high - low)) for share in LEVELS]
    return TrunkSections(
        breadth_m=np.array([breadth for breadth, _ in extents]),
        depth_m=np.array([depth for _, depth in extents]),
    )


def _trunk_extent(body: Vertices, triangles: Triangles, height_m: float) -> tuple[float, float]:
    points, loop = _section(body, triangles, height_m)
    reach = np.full(loop.max() + 1, np.inf)
    np.minimum.at(reach, loop, np.abs(points[:, 0]))
    trunk = points[reach[loop] < NEAR_MIDDLE_M]
    return float(np.ptp(trunk[:, 0])), float(np.ptp(trunk[:, 2]))


def _section(
    body: Vertices, triangles: Triangles, height_m: float
) -> tuple[Float[np.ndarray, "k 3"], Integer[np.ndarray, " k"]]:
    """Where edges pass through a level, and the number of the loop each point belongs to."""
    above = body[:, 1] > height_m
    cut = triangles[above[triangles].any(axis=1) & ~above[triangles].all(axis=1)]
    edges = np.sort(cut[:, [[0, 1], [1, 2], [2, 0]]], axis=2)
    crossed = above[edges[..., 0]] != above[edges[..., 1]]
    # Two edges of every cut triangle cross; they are neighbours in a loop.
    pairs, number = np.unique(edges[crossed], axis=0, return_inverse=True)
    links = number.reshape(-1, 2)
    graph = sparse.coo_array((np.ones(len(links)), links.T), shape=(len(pairs), len(pairs)))
    _, loop = connected_components(graph, directed=False)
    start, end = body[pairs[:, 0]], body[pairs[:, 1]]
    share = (height_m - start[:, 1]) / (end[:, 1] - start[:, 1])
    return start + share[:, None] * (end - start), loop
