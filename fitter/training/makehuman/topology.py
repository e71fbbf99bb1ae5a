"""Cut the cavities out of the base mesh, cap the openings and split quads into triangles."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Integer
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from fitter.arrays import Triangles, Vertices

LARGEST_CAVITY_QUADS = 500
"""The texture layout gives every cavity an island of its own: the mouth's has 398 quads, each eye
socket's 293; the smallest island of outer skin, a foot, has 1,072."""

MIDDLE = 1e-6
"""Metres from the plane of symmetry within which a vertex lies on it."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ClosedSurface:
    """Triangles over the vertices, and over the texture coordinates, of the quads given.

    ``cap_triangles`` are the ids of those that close the openings.
    """

    triangles: Triangles
    uv_triangles: Triangles
    cap_triangles: Integer[np.ndarray, " c"]


def closed_surface(
    vertices: Vertices, quads: Integer[np.ndarray, "q 4"], uv_quads: Integer[np.ndarray, "q 4"]
) -> ClosedSurface:
    """The outer skin of a closed quad mesh: cavities removed, their openings capped.

    No vertex is added, so that every vertex stays a vertex of the source. Quads are split along
    their shorter diagonal, which keeps the mesh as symmetric as its vertices are.
    """
    skin = ~cavity_quads(uv_quads)
    quads, uv_quads = quads[skin], uv_quads[skin]
    uv_of_vertex = dict(zip(quads.ravel().tolist(), uv_quads.ravel().tolist(), strict=True))
    caps = np.array(
        [triangle for loop in _boundary_loops(quads) for triangle in _cap(vertices, loop)],
        dtype=np.int32,
    )
    uv_caps = np.array([[uv_of_vertex[v] for v in triangle] for triangle in caps.tolist()])
    corners = _split_corners(vertices, quads)
    return ClosedSurface(
        triangles=np.concatenate(
            [*(np.take_along_axis(quads, corner, axis=1) for corner in corners), caps]
        ),
        uv_triangles=np.concatenate(
            [*(np.take_along_axis(uv_quads, corner, axis=1) for corner in corners), uv_caps]
        ),
        cap_triangles=2 * len(quads) + np.arange(len(caps)),
    )


def cavity_quads(uv_quads: Integer[np.ndarray, "q 4"]) -> Bool[np.ndarray, " q"]:
    """The quads that line mouth and eye sockets: those of the small texture islands."""
    starts, ends = uv_quads.ravel(), np.roll(uv_quads, -1, axis=1).ravel()
    count = int(uv_quads.max()) + 1
    links = sparse.coo_array((np.ones(len(starts)), (starts, ends)), shape=(count, count))
    _, island_of_uv = connected_components(links, directed=False)
    island = island_of_uv[uv_quads[:, 0]]
    return np.bincount(island)[island] < LARGEST_CAVITY_QUADS


def _boundary_loops(quads: Integer[np.ndarray, "q 4"]) -> Iterator[list[int]]:
    """Loops of edges with a quad on one side only, running as a capping polygon runs."""
    starts, ends = quads.ravel(), np.roll(quads, -1, axis=1).ravel()
    inner = set(zip(starts.tolist(), ends.tolist(), strict=True))
    following = {end: start for start, end in inner if (end, start) not in inner}
    while following:
        loop = [min(following)]
        while (after := following.pop(loop[-1])) != loop[0]:
            loop.append(after)
        yield loop


def _cap(vertices: Vertices, loop: list[int]) -> Iterator[list[int]]:
    """Triangles across the opening of a loop that lies on one side of the body or on both.

    Every ladder starts at the corner farthest from the body's middle, so that the caps of both
    sides, and both halves of the mouth's, mirror each other.
    """
    x = vertices[loop, 0]
    if x.min() * x.max() > 0.0:
        lateral, medial = int(np.argmax(np.abs(x))), int(np.argmin(np.abs(x)))
        yield from _ladder(vertices, _run(loop, lateral, medial), _run(loop, medial, lateral)[::-1])
        return
    right, left = int(np.argmin(x)), int(np.argmax(x))
    first, second = sorted(np.flatnonzero(np.abs(x) < MIDDLE).tolist())
    for lateral in (right, left):
        after, before = (second, first) if first < lateral < second else (first, second)
        yield from _ladder(vertices, _run(loop, lateral, after), _run(loop, before, lateral)[::-1])


def _run(loop: list[int], start: int, stop: int) -> list[int]:
    """The loop's vertices from one position on to another, both included."""
    count = (stop - start) % len(loop) + 1
    return [loop[(start + k) % len(loop)] for k in range(count)]


def _ladder(vertices: Vertices, ahead: list[int], behind: list[int]) -> Iterator[list[int]]:
    """Triangles between two chains that start at one corner, always by the shorter next rung.

    ``ahead`` runs with the loop, ``behind`` against it.
    """
    i = j = 0
    while i + 1 < len(ahead) or j + 1 < len(behind):
        if j + 1 == len(behind) or (
            i + 1 < len(ahead)
            and np.linalg.norm(vertices[ahead[i + 1]] - vertices[behind[j]])
            <= np.linalg.norm(vertices[ahead[i]] - vertices[behind[j + 1]])
        ):
            triangle = [ahead[i], ahead[i + 1], behind[j]]
            i += 1
        else:
            triangle = [behind[j + 1], behind[j], ahead[i]]
            j += 1
        if len(set(triangle)) == 3:
            yield triangle


def _split_corners(
    vertices: Vertices, quads: Integer[np.ndarray, "q 4"]
) -> tuple[Integer[np.ndarray, "q 3"], Integer[np.ndarray, "q 3"]]:
    """Corners of both triangles of each quad, split along the shorter diagonal."""
    corners = vertices[quads]
    across = np.linalg.norm(corners[:, 0] - corners[:, 2], axis=1) - np.linalg.norm(
        corners[:, 1] - corners[:, 3], axis=1
    )
    # A tie within rounding must fall alike on both sides of the body.
    by_first = (across < 1e-9)[:, None]
    return (
        np.where(by_first, [0, 1, 2], [0, 1, 3]),
        np.where(by_first, [0, 2, 3], [1, 2, 3]),
    )
