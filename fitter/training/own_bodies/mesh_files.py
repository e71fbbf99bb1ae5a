"""Vertices and triangles out of OBJ and NPY files, in the file's own order.

Vertex order is what registration means, so nothing here merges, splits or sorts: programs that
"clean up" a mesh while they read it destroy the correspondence without a word.
"""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from fitter.arrays import Triangles, Vertices
from fitter.errors import MeshFolderError


class MeshFile(NamedTuple):
    """A file's vertices, (m, 3) once :func:`read_mesh` has seen to it, and triangles if it has any.

    Polygons are cut into fans.
    """

    vertices: Float[np.ndarray, "..."]
    triangles: Triangles | None = None


def read_mesh(path: Path, *, place: str) -> MeshFile:
    """Read a mesh file by its ending; ``place`` names it in errors.

    Raises
    ------
    MeshFolderError
        If it cannot be read, is not (m, 3), or holds numbers that are not finite.
    """
    try:
        mesh = READERS[path.suffix.lower()](path)
    except Exception as error:
        # Whatever a damaged file makes a parser stumble over: no list of types is complete.
        raise MeshFolderError(
            place=place,
            reason=f"cannot be read as {path.suffix[1:].upper()} ({error or 'it is cut short'})",
            remedy="Export it again, with the positions of all vertices in x, y and z.",
        ) from error
    vertices = mesh.vertices
    if vertices.ndim != 2 or vertices.shape[1] != 3 or not len(vertices):
        raise MeshFolderError(
            place=place,
            reason=f"holds an array of shape {vertices.shape}, expected (vertices, 3)",
            remedy="Write one file a body.",
        )
    bad = np.flatnonzero(~np.isfinite(vertices).all(axis=1))
    if len(bad):
        raise MeshFolderError(
            place=place,
            reason=f"has {len(bad)} vertices that are not finite, the first is {bad[0]}",
            remedy="Repair the registration, or leave this file out.",
        )
    return mesh


def write_obj(path: Path, vertices: Vertices, triangles: Triangles) -> None:
    """Write an OBJ file, positions to a tenth of a micrometre."""
    lines = [f"v {x:.7f} {y:.7f} {z:.7f}" for x, y, z in vertices.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (triangles + 1).tolist()]
    path.write_text("\n".join(lines) + "\n")


def _read_obj(path: Path) -> MeshFile:
    vertices: list[list[float]] = []
    triangles: list[list[int]] = []
    for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
        kind, *words = line.split() or ("",)
        if kind == "v":
            vertices.append([float(word) for word in words[:3]])
        elif kind == "f":
            corners = [_index(word.partition("/")[0], len(vertices)) for word in words]
            triangles += [[corners[0], *corners[k : k + 2]] for k in range(1, len(corners) - 1)]
    return MeshFile(np.array(vertices), np.array(triangles, dtype=np.int32) if triangles else None)


def _read_npy(path: Path) -> MeshFile:
    return MeshFile(np.load(path, allow_pickle=False).astype(np.float64))


READERS: Mapping[str, Callable[[Path], MeshFile]] = {".obj": _read_obj, ".npy": _read_npy}


def _index(word: str, count: int) -> int:
    """OBJ counts from 1, or backward from the last one read so far."""
    number = int(word)
    return number - 1 if number > 0 else count + number
