"""``template.json`` and the files it names: read, check, and write a folder to start from."""

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Triangles, Vertices
from fitter.body.model import SparseRows
from fitter.body.model_checks import involution_fault, shares_fault
from fitter.errors import MeshFolderError
from fitter.fits.usable_model import needed_landmarks
from fitter.numerics.mesh_faults import closed_surface_fault, solid_fault
from fitter.training.articulation.part_tree import PART_NAMES
from fitter.training.articulation.parts import Parts, cut_into_parts, joined_parts
from fitter.training.assemble import BodyMesh
from fitter.training.own_bodies.frame import BODY_FRAME, Frame, axes_entry
from fitter.training.own_bodies.json_entries import Entries, numbers, read_entries, whole_numbers
from fitter.training.own_bodies.mesh_files import MeshFile, read_mesh, write_obj
from fitter.training.own_bodies.template import (
    JOINT_LANDMARKS,
    Template,
    blended_weights,
    nearest_mirror,
)

TEMPLATE_FILE = "template.json"
BODIES_FILE = "bodies.json"

_MEND = "Mend the template in the program it was made with, and register to it again."
_KNOWN = (
    "mesh",
    "part_names",
    "part_of_triangle",
    "skinning_weights",
    "joints",
    "landmarks",
    "mirror",
)


def read_template(folder: Path, frame: Frame) -> Template:
    """Read ``template.json``.

    Raises
    ------
    MeshFolderError
        If something is missing or contradicts something else; the message names the entry.
    """
    entries = read_entries(
        folder / TEMPLATE_FILE,
        remedy="`python -m fitter.training template --meshes FOLDER` writes one to start from.",
    )
    entries.only(_KNOWN)
    file_name = entries.get("mesh", str)
    if not (folder / file_name).is_file() or Path(file_name).suffix.lower() not in (".obj", ".ply"):
        entries.fail("mesh", f"names {file_name}", "Name an OBJ or PLY file in the folder.")
    surface = read_mesh(folder / file_name, place=file_name)
    vertices = frame.to_body(surface.vertices)
    triangles = _checked_triangles(file_name, vertices, surface.triangles)
    order = _part_order(entries)
    uv, uv_triangles = surface.uv, surface.uv_triangles
    if uv is None or uv_triangles is None:
        uv, uv_triangles = np.zeros((1, 2)), np.zeros_like(triangles)
    return Template(
        name=f"a topology of the user's with {len(vertices)} vertices",
        vertices=vertices,
        mesh=BodyMesh(
            triangles=triangles,
            parts=_parts(entries, folder, vertices, triangles, order),
            joint_regressor=_rows(entries.object("joints"), PART_NAMES, len(vertices)),
            landmarks=_landmarks(entries, len(vertices)),
            uv=uv,
            uv_triangles=uv_triangles,
            mirror=_mirror(entries, folder, vertices),
        ),
    )


def write_starting_folder(folder: Path, template: Template) -> None:
    """Write a template with its ``bodies.json``, in metres and the body frame's axes."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in ("rest", "posed"):
        (folder / name).mkdir(exist_ok=True)
    mesh = template.mesh
    write_obj(
        folder / "template.obj",
        MeshFile(
            vertices=template.vertices,
            triangles=mesh.triangles,
            uv=mesh.uv,
            uv_triangles=mesh.uv_triangles,
        ),
    )
    weights = np.zeros((len(template.vertices), len(PART_NAMES)), dtype=np.float32)
    every = np.arange(len(weights))[:, None]
    np.add.at(weights, (every, mesh.parts.skinning_parts), mesh.parts.skinning_weights)
    for name, array in {
        "part_of_triangle": mesh.parts.part_of_triangle,
        "skinning_weights": weights,
        "mirror": mesh.mirror,
    }.items():
        np.save(folder / f"{name}.npy", array)
    description = {
        "mesh": "template.obj",
        "part_names": list(PART_NAMES),
        "part_of_triangle": "part_of_triangle.npy",
        "skinning_weights": "skinning_weights.npy",
        "mirror": "mirror.npy",
        "joints": _row_entries(mesh.joint_regressor),
        "landmarks": _row_entries(mesh.landmarks),
    }
    bodies = {
        "units": BODY_FRAME.unit,
        "axes": axes_entry(BODY_FRAME.axes),
        "source": "",
        "licence": "",
    }
    for name, content in {TEMPLATE_FILE: description, BODIES_FILE: bodies}.items():
        (folder / name).write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


def _checked_triangles(place: str, vertices: Vertices, triangles: Triangles | None) -> Triangles:
    if triangles is None:
        raise MeshFolderError(
            place=place,
            reason="has no triangles, or polygons of differing size",
            remedy="Export it with its triangles, as OBJ.",
        )
    if triangles.min() < 0 or triangles.max() >= len(vertices):
        raise MeshFolderError(
            place=place, reason="has triangles beyond its vertices", remedy="Export it again."
        )
    fault = closed_surface_fault(triangles, vertex_count=len(vertices)) or solid_fault(
        vertices, triangles
    )
    if fault is not None:
        raise MeshFolderError(place=place, reason=fault, remedy=_MEND)
    return triangles


def _part_order(entries: Entries) -> Integer[np.ndarray, " p"]:
    """Where each of our parts stands among the template's."""
    names = entries.get("part_names", list)
    if sorted(map(str, names)) != sorted(PART_NAMES):
        entries.fail(
            "part_names",
            f"are {len(names)} names, expected these {len(PART_NAMES)}: {', '.join(PART_NAMES)}",
            "Join finer parts (fingers, toes, vertebrae) to these; OWN_BODIES.md shows how.",
        )
    return np.array([names.index(name) for name in PART_NAMES])


def _parts(
    entries: Entries,
    folder: Path,
    vertices: Vertices,
    triangles: Triangles,
    order: Integer[np.ndarray, " p"],
) -> Parts:
    """From ``skinning_weights``, ``part_of_triangle`` or both: each can be had from the other."""
    blamed = "part_of_triangle" if "part_of_triangle" in entries.values else "skinning_weights"
    if "part_of_triangle" in entries.values:
        given = _part_of_triangle(entries, folder, len(triangles), order)
        if "skinning_weights" in entries.values:
            weights = _skinning_weights(entries, folder, len(vertices), order)
        else:
            weights = blended_weights(vertices, triangles, given)
        parts = joined_parts(triangles, given, weights)
    else:
        parts = cut_into_parts(triangles, _skinning_weights(entries, folder, len(vertices), order))
    empty = np.flatnonzero(np.diff(parts.incidence_pointers) == 0)
    if len(empty):
        entries.fail(
            blamed,
            f"gives {PART_NAMES[empty[0]]} no triangle",
            "Every part needs some skin of its own.",
        )
    return parts


def _part_of_triangle(
    entries: Entries, folder: Path, count: int, order: Integer[np.ndarray, " p"]
) -> Integer[np.ndarray, " f"]:
    given = whole_numbers(entries, "part_of_triangle", folder)
    if given.shape != (count,) or given.min() < 0 or given.max() >= len(order):
        entries.fail(
            "part_of_triangle",
            f"has shape {given.shape} and runs {given.min()} ... {given.max()}, expected "
            f"({count},) and places among part_names, 0 ... {len(order) - 1}",
            "Give every triangle of the mesh its part.",
        )
    return np.argsort(order)[given]


def _skinning_weights(
    entries: Entries, folder: Path, count: int, order: Integer[np.ndarray, " p"]
) -> Float[np.ndarray, "m p"]:
    weights = numbers(entries, "skinning_weights", folder)
    if weights.shape != (count, len(order)):
        entries.fail(
            "skinning_weights",
            f"has shape {weights.shape}, expected ({count}, {len(order)})",
            "Give every vertex its share of every part, in the order of part_names.",
        )
    fault = shares_fault(weights)
    if fault is not None:
        entries.fail("skinning_weights", fault, "Divide each row by its sum.")
    return weights[:, order]


def _landmarks(entries: Entries, vertex_count: int) -> SparseRows:
    joints, given = entries.object("joints"), entries.object("landmarks")
    values = dict(given.values)
    for landmark, limb in JOINT_LANDMARKS.items():
        for side in ("left", "right"):
            values.setdefault(f"{side}_{landmark}", joints.values[f"{side}_{limb}"])
    missing = [name for name in needed_landmarks() if name not in values]
    if missing:
        given.fail(
            missing[0],
            f"is missing, as are {len(missing) - 1} others" if len(missing) > 1 else "is missing",
            f"A fit needs: {', '.join(missing)}. Give each a vertex, or several.",
        )
    return _rows(Entries(given.place, values), tuple(values), vertex_count)


def _rows(entries: Entries, names: Sequence[str], vertex_count: int) -> SparseRows:
    """One weighted mean of vertices for each name."""
    found = [_row(entries, name, vertex_count) for name in names]
    return SparseRows(
        names=tuple(names),
        pointers=np.cumsum([0, *(len(vertices) for vertices, _ in found)]).astype(np.int32),
        indices=np.concatenate([vertices for vertices, _ in found]).astype(np.int32),
        weights=np.concatenate([weights for _, weights in found]),
    )


def _row(
    entries: Entries, name: str, vertex_count: int
) -> tuple[Integer[np.ndarray, " z"], Float[np.ndarray, " z"]]:
    """A vertex, the mean of a list of vertices, or an object of ``vertices`` and ``weights``."""
    remedy = 'Write a vertex, a list of them, or {"vertices": [...], "weights": [...]}.'
    value = entries.values.get(name)
    if value is None:
        entries.fail(name, "is missing", remedy)
    pair = value if isinstance(value, dict) else {"vertices": value}
    try:
        vertices = np.atleast_1d(np.array(pair["vertices"]))
        weights = np.array(pair.get("weights", np.full(len(vertices), 1.0 / len(vertices))), float)
    except (KeyError, ValueError, TypeError, ZeroDivisionError):
        entries.fail(name, "is no weighted mean of vertices", remedy)
    if vertices.dtype.kind not in "iu" or vertices.ndim != 1 or weights.shape != vertices.shape:
        entries.fail(name, "is no weighted mean of vertices", remedy)
    if vertices.min() < 0 or vertices.max() >= vertex_count:
        outside = vertices[(vertices < 0) | (vertices >= vertex_count)][0]
        entries.fail(name, f"names vertex {outside}, the mesh has {vertex_count}", remedy)
    if not np.isclose(weights.sum(), 1.0, atol=1e-4):
        entries.fail(name, f"has weights that sum to {weights.sum():.6g}, expected 1", remedy)
    return vertices, weights / weights.sum()


def _mirror(entries: Entries, folder: Path, vertices: Vertices) -> Integer[np.ndarray, " m"]:
    if "mirror" not in entries.values:
        return nearest_mirror(vertices)
    mirror = whole_numbers(entries, "mirror", folder)
    remedy = "Mend it, or leave it out: then the vertex nearest to the mirror image is taken."
    if mirror.shape != (len(vertices),) or mirror.min() < 0 or mirror.max() >= len(vertices):
        entries.fail("mirror", f"is no map of {len(vertices)} vertices", remedy)
    fault = involution_fault(mirror)
    if fault is not None:
        entries.fail("mirror", fault, remedy)
    return mirror.astype(np.int32)


def _row_entries(rows: SparseRows) -> dict[str, dict[str, list[float]]]:
    entries = {}
    for name, start, stop in zip(rows.names, rows.pointers[:-1], rows.pointers[1:], strict=True):
        entries[name] = {
            "vertices": rows.indices[start:stop].tolist(),
            "weights": [round(weight, 9) for weight in rows.weights[start:stop].tolist()],
        }
    return entries
