"""Vertices and triangles out of OBJ, PLY, NPY and NPZ files, in the file's own order.

Vertex order is what registration means, so nothing here merges, splits or sorts: programs that
"clean up" a mesh while they read it destroy the correspondence without a word.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Triangles
from fitter.errors import MeshFolderError
from fitter.training.own_bodies.ply_files import read_ply


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MeshFile:
    """What a file holds, in its own units and axes; None where it has no such thing.

    Vertices are (m, 3) once :func:`read_mesh` has seen to it. Polygons are cut into fans. Texture
    coordinates come from OBJ files only.
    """

    vertices: Float[np.ndarray, "..."]
    triangles: Triangles | None = None
    uv: Float[np.ndarray, "u 2"] | None = None
    uv_triangles: Triangles | None = None


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


def write_obj(path: Path, mesh: MeshFile) -> None:
    """Write an OBJ file, positions to a tenth of a millionth of the unit."""
    lines = [f"v {x:.7f} {y:.7f} {z:.7f}" for x, y, z in mesh.vertices.tolist()]
    corners = [] if mesh.triangles is None else (mesh.triangles + 1).astype(str)
    if mesh.triangles is not None and mesh.uv is not None and mesh.uv_triangles is not None:
        lines += [f"vt {u:.6f} {v:.6f}" for u, v in mesh.uv.tolist()]
        textures = (mesh.uv_triangles + 1).astype(str)
        corners = np.strings.add(np.strings.add(corners, "/"), textures)
    lines += [f"f {' '.join(corner)}" for corner in corners]
    path.write_text("\n".join(lines) + "\n")


def _read_obj(path: Path) -> MeshFile:
    vertices: list[list[float]] = []
    uv: list[list[float]] = []
    triangles: list[list[int]] = []
    uv_triangles: list[list[int]] = []
    for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
        kind, *words = line.split() or ("",)
        if kind == "v":
            vertices.append([float(word) for word in words[:3]])
        elif kind == "vt":
            uv.append([float(word) for word in words[:2]])
        elif kind == "f":
            corners = [word.split("/") for word in words]
            triangles += _fan([_index(corner[0], len(vertices)) for corner in corners])
            if all(len(corner) > 1 and corner[1] for corner in corners):
                uv_triangles += _fan([_index(corner[1], len(uv)) for corner in corners])
    textured = len(uv_triangles) == len(triangles) > 0
    return MeshFile(
        vertices=np.array(vertices),
        triangles=np.array(triangles, dtype=np.int32) if triangles else None,
        uv=np.array(uv) if textured else None,
        uv_triangles=np.array(uv_triangles, dtype=np.int32) if textured else None,
    )


def _read_ply(path: Path) -> MeshFile:
    vertices, polygons = read_ply(path)
    return MeshFile(vertices=vertices, triangles=None if polygons is None else _fans(polygons))


def _read_npy(path: Path) -> MeshFile:
    return MeshFile(vertices=np.load(path, allow_pickle=False).astype(np.float64))


def _read_npz(path: Path) -> MeshFile:
    with np.load(path, allow_pickle=False) as archive:
        if "vertices" not in archive.files:
            message = f"no array `vertices` among {', '.join(archive.files)}"
            raise ValueError(message)
        return MeshFile(vertices=archive["vertices"].astype(np.float64))


READERS: Mapping[str, Callable[[Path], MeshFile]] = {
    ".obj": _read_obj,
    ".ply": _read_ply,
    ".npy": _read_npy,
    ".npz": _read_npz,
}


def _index(word: str, count: int) -> int:
    """OBJ counts from 1, or backward from the last one read so far."""
    number = int(word)
    return number - 1 if number > 0 else count + number


def _fan(corners: list[int]) -> list[list[int]]:
    return [[corners[0], corners[k], corners[k + 1]] for k in range(1, len(corners) - 1)]


def _fans(polygons: Integer[np.ndarray, "_ c"]) -> Triangles:
    fans = [polygons[:, [0, k, k + 1]] for k in range(1, polygons.shape[1] - 1)]
    return np.stack(fans, axis=1).reshape(-1, 3).astype(np.int32)
