"""The template that meshes were registered to, with its anatomy.

``template.npz`` holds one; without it a folder's meshes are on the packaged topology. OWN_BODIES.md
lists its arrays.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import NoReturn

import numpy as np
from jaxtyping import Float, Integer
from scipy import sparse
from scipy.spatial import KDTree

from fitter.arrays import Triangles, Vertices
from fitter.body.model import BodyModel, SparseRows
from fitter.errors import MeshFolderError
from fitter.fits.usable_model import needed_landmarks
from fitter.numerics.mesh_faults import closed_surface_fault, solid_fault
from fitter.training.articulation.parts import PART_NAMES, Parts, joined_parts, parts_of
from fitter.training.assemble import BodyMesh

TEMPLATE_FILE = "template.npz"

_KINDS: Mapping[str, str] = {
    "vertices": "f",
    "triangles": "iu",
    "part_of_triangle": "iu",
    "skinning_weights": "f",
    "joints": "f",
    "landmark_names": "U",
    "landmarks": "f",
    "uv": "f",
    "uv_triangles": "iu",
}
"""The arrays of the file, and numpy's letters for what each may hold."""


_SUM_TOLERANCE = 1e-4
"""Tolerance of weights that sum to one, kept in single precision."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Template:
    """A mesh with its anatomy.

    Attributes
    ----------
    name
        For the header: which topology this is.
    vertices
        (m, 3) a body at rest, body frame, metres.
    mesh
        Triangles, parts, joints, landmarks, texture layout and mirror map.
    """

    name: str
    vertices: Vertices
    mesh: BodyMesh


def packaged_template(model: BodyModel) -> Template:
    """The packaged model's own topology; bodies on it need say nothing but their vertices."""
    return Template(
        name=f"the packaged topology of {len(model.mean_vertices)} vertices",
        vertices=model.mean_vertices,
        mesh=BodyMesh(
            triangles=model.triangles,
            parts=parts_of(model),
            joint_regressor=model.joint_regressor,
            landmarks=model.landmarks,
            uv=model.uv,
            uv_triangles=model.uv_triangles,
            mirror=model.mirror,
        ),
    )


def same_surface(first: BodyMesh, second: BodyMesh) -> bool:
    """Whether two meshes have the same triangles in the same parts, so that E means the same."""
    return np.array_equal(first.triangles, second.triangles) and np.array_equal(
        first.parts.part_of_triangle, second.parts.part_of_triangle
    )


def read_template(path: Path) -> Template:
    """Read and check a ``template.npz``.

    Raises
    ------
    MeshFolderError
        If an array is missing or contradicts another; the message names it.
    """
    arrays = _read_arrays(path)
    vertices, triangles = arrays["vertices"], arrays["triangles"]
    count = len(vertices)
    _check_shapes(arrays, count)
    if triangles.min() < 0 or triangles.max() >= count:
        _fail("triangles", f"run beyond the {count} vertices")
    fault = closed_surface_fault(triangles, vertex_count=count) or solid_fault(vertices, triangles)
    if fault is not None:
        _fail("triangles", fault)
    return Template(
        name=f"a topology of the user's with {count} vertices",
        vertices=vertices.astype(np.float64),
        mesh=BodyMesh(
            triangles=triangles.astype(np.int32),
            parts=_parts(arrays),
            joint_regressor=_rows(arrays, "joints", PART_NAMES),
            landmarks=_landmarks(arrays),
            uv=arrays["uv"].astype(np.float64),
            uv_triangles=arrays["uv_triangles"].astype(np.int32),
            mirror=nearest_mirror(vertices),
        ),
    )


def write_template(path: Path, template: Template) -> None:
    """Write a template as :func:`read_template` reads it."""
    mesh, count = template.mesh, len(template.vertices)
    weights = np.zeros((count, len(PART_NAMES)))
    np.put_along_axis(weights, mesh.parts.skinning_parts, mesh.parts.skinning_weights, axis=1)
    np.savez_compressed(
        path,
        vertices=template.vertices,
        triangles=mesh.triangles,
        part_of_triangle=mesh.parts.part_of_triangle,
        skinning_weights=weights,
        joints=_dense(mesh.joint_regressor, count),
        landmark_names=np.array(mesh.landmarks.names),
        landmarks=_dense(mesh.landmarks, count),
        uv=mesh.uv,
        uv_triangles=mesh.uv_triangles,
    )


def nearest_mirror(vertices: Vertices) -> Integer[np.ndarray, " m"]:
    """The vertex on the other side: the one nearest to the mirror image, where both agree.

    A vertex without such a partner is its own, so that the map is its own inverse on any mesh.
    """
    middle = 0.5 * (vertices[:, 0].min() + vertices[:, 0].max())
    mirrored = vertices * [-1.0, 1.0, 1.0] + [2.0 * middle, 0.0, 0.0]
    nearest = np.asarray(KDTree(vertices).query(mirrored)[1])
    every = np.arange(len(vertices))
    return np.where(nearest[nearest] == every, nearest, every).astype(np.int32)


def _read_arrays(path: Path) -> dict[str, np.ndarray]:
    try:
        with np.load(path, allow_pickle=False) as archive:
            arrays = dict(archive)
    except Exception as error:
        # Whatever a damaged archive makes numpy stumble over.
        raise MeshFolderError(
            place=path.name, reason=f"cannot be read ({error})", remedy="Write it anew."
        ) from error
    for name, kind in _KINDS.items():
        if name not in arrays:
            _fail(name, "is missing")
        if arrays[name].dtype.kind not in kind:
            _fail(name, f"holds {arrays[name].dtype}")
    return arrays


def _check_shapes(arrays: Mapping[str, np.ndarray], count: int) -> None:
    triangles: Triangles = arrays["triangles"]
    parts = len(PART_NAMES)
    shapes = {
        "vertices": (count, 3),
        "triangles": (len(triangles), 3),
        "part_of_triangle": (len(triangles),),
        "skinning_weights": (count, parts),
        "joints": (parts, count),
        "landmarks": (len(arrays["landmark_names"]), count),
        "uv_triangles": (len(triangles), 3),
    }
    for name, shape in shapes.items():
        if arrays[name].shape != shape:
            _fail(name, f"has shape {arrays[name].shape}, expected {shape}")


def _parts(arrays: Mapping[str, np.ndarray]) -> Parts:
    weights, given = arrays["skinning_weights"], arrays["part_of_triangle"]
    fault = _shares_fault(weights)
    if fault is not None:
        _fail("skinning_weights", fault)
    if not np.array_equal(np.unique(given), np.arange(len(PART_NAMES))):
        names = ", ".join(PART_NAMES)
        _fail("part_of_triangle", f"does not give each of {names} some triangles, by its place")
    return joined_parts(arrays["triangles"], given, weights.astype(np.float64))


def _shares_fault(weights: Float[np.ndarray, "m k"]) -> str | None:
    """Why rows are not shares of a whole; None if they are."""
    if (weights < 0.0).any():
        vertex = int(np.argmax((weights < 0.0).any(axis=1)))
        return f"holds {weights[vertex].min():.4g} at vertex {vertex}, expected no negative weight"
    sums = weights.sum(axis=1, dtype=np.float64)
    worst = int(np.argmax(np.abs(sums - 1.0)))
    if abs(sums[worst] - 1.0) > _SUM_TOLERANCE:
        return f"sums to {sums[worst]:.6g} at vertex {worst}, expected 1"
    return None


def _landmarks(arrays: Mapping[str, np.ndarray]) -> SparseRows:
    names = tuple(arrays["landmark_names"].tolist())
    missing = [name for name in needed_landmarks() if name not in names]
    if missing:
        _fail("landmark_names", f"lack what a fit needs: {', '.join(missing)}")
    return _rows(arrays, "landmarks", names)


def _rows(arrays: Mapping[str, np.ndarray], name: str, names: tuple[str, ...]) -> SparseRows:
    """Weighted means of vertices."""
    dense: Float[np.ndarray, "r m"] = arrays[name].astype(np.float64)
    sums = dense.sum(axis=1)
    off = np.flatnonzero(~np.isclose(sums, 1.0, atol=_SUM_TOLERANCE))
    if len(off):
        _fail(name, f"weigh {names[off[0]]} by {sums[off[0]]:.6g} in all, expected 1")
    rows = sparse.csr_array(dense / sums[:, None])
    return SparseRows(
        names=names,
        pointers=rows.indptr.astype(np.int32),
        indices=rows.indices.astype(np.int32),
        weights=rows.data,
    )


def _dense(rows: SparseRows, count: int) -> Float[np.ndarray, "r m"]:
    shape = (len(rows.names), count)
    return sparse.csr_array((rows.weights, rows.indices, rows.pointers), shape=shape).toarray()


def _fail(name: str, reason: str) -> NoReturn:
    raise MeshFolderError(
        place=f"{TEMPLATE_FILE}: {name}",
        reason=reason,
        remedy="Mend it; the file that the command `template` writes is the example to follow.",
    )
