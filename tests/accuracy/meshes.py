"""Meshes that are drawn: MakeHuman's faces by group, quads split so that colours have vertices."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from jaxtyping import Float, Integer
from scipy import sparse

from fitter.arrays import Normals, PerVertex, Triangles, Vertices
from fitter.training.makehuman.meshes import makehuman_folder


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PersonMesh:
    """A part of the person; vertices in the world, metres, albedo linear.

    ``labels`` (k,) is the :class:`Label` of each vertex.
    """

    vertices: Vertices
    normals: Normals
    triangles: Triangles
    albedo: Float[np.ndarray, "k 3"]
    roughness: PerVertex
    labels: Integer[np.ndarray, " k"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Faces:
    """Quads of one group over the source vertices, and over the texture coordinates."""

    quads: Integer[np.ndarray, "q 4"]
    uv_quads: Integer[np.ndarray, "q 4"]


@cache
def faces_of_group(group: str) -> Faces:
    """The faces of ``body``, ``helper-l-eye`` and so on."""
    quads: list[list[int]] = []
    uv_quads: list[list[int]] = []
    current = ""
    for line in _base_file().read_text().splitlines():
        kind, *fields = line.split() or ("",)
        if kind == "g":
            current = fields[0]
        elif kind == "f" and current == group:
            corners = [[int(number) - 1 for number in field.split("/")[:2]] for field in fields]
            quads.append([corner[0] for corner in corners])
            uv_quads.append([corner[1] for corner in corners])
    return Faces(quads=np.array(quads), uv_quads=np.array(uv_quads))


@cache
def texture_coordinates() -> Float[np.ndarray, "u 2"]:
    """All texture coordinates of the base mesh, v upward."""
    lines = _base_file().read_text().splitlines()
    return np.array([line.split()[1:3] for line in lines if line.startswith("vt ")], dtype=float)


def _base_file() -> Path:
    return makehuman_folder() / "3dobjs" / "base.obj"


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Refined:
    """Every new vertex as a mean of old ones.

    ``rows`` (k, m) sparse, rows sum to one; ``quads`` (4^n q, 4) over the new vertices.
    """

    rows: sparse.csr_array
    quads: Integer[np.ndarray, "r 4"]


def refined(quads: Integer[np.ndarray, "q 4"], vertex_count: int, *, times: int) -> Refined:
    """Cut each quad into four, ``times`` over: flat quads stay flat, no vertex moves."""
    rows = sparse.csr_array(sparse.eye_array(vertex_count))
    for _ in range(times):
        step = _refined_once(quads, vertex_count)
        rows, quads = sparse.csr_array(step.rows @ rows), step.quads
        vertex_count = len(step.rows.indptr) - 1
    return Refined(rows=rows, quads=quads)


def triangulated(quads: Integer[np.ndarray, "q 4"]) -> Integer[np.ndarray, "f 3"]:
    """Two triangles a quad."""
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def vertex_normals(
    vertices: Float[np.ndarray, "m 3"], triangles: Integer[np.ndarray, "f 3"]
) -> Float[np.ndarray, "m 3"]:
    """Area-weighted unit normals, apart from the fitter's own so that the pictures do not share
    its code."""
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    facets = np.cross(b - a, c - a)
    owners = triangles.T.ravel()
    total = np.stack(
        [
            np.bincount(owners, np.tile(facets[:, axis], 3), minlength=len(vertices))
            for axis in range(3)
        ],
        axis=1,
    )
    return total / np.maximum(np.linalg.norm(total, axis=1, keepdims=True), 1e-20)


def _refined_once(quads: Integer[np.ndarray, "q 4"], count: int) -> Refined:
    ends = np.stack([quads, np.roll(quads, -1, axis=1)], axis=2).reshape(-1, 2)
    edges, edge_of_corner = np.unique(np.sort(ends, axis=1), axis=0, return_inverse=True)
    edge_of_corner = edge_of_corner.reshape(-1, 4)
    middles = count + edge_of_corner
    centres = count + len(edges) + np.arange(len(quads))
    before = np.roll(middles, 1, axis=1)
    parts = [
        np.stack([quads[:, k], middles[:, k], centres, before[:, k]], axis=1) for k in range(4)
    ]
    total = count + len(edges) + len(quads)
    row = np.concatenate(
        [
            np.arange(count),
            count + np.repeat(np.arange(len(edges)), 2),
            np.repeat(centres, 4),
        ]
    )
    column = np.concatenate([np.arange(count), edges.ravel(), quads.ravel()])
    value = np.concatenate(
        [np.ones(count), np.full(2 * len(edges), 0.5), np.full(quads.size, 0.25)]
    )
    return Refined(
        rows=sparse.csr_array((value, (row, column)), shape=(total, count)),
        quads=np.concatenate(parts),
    )
