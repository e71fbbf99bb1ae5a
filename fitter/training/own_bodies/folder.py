"""A folder of registered meshes: which files it holds, read and checked, in the body frame.

::

    FOLDER/bodies.json            units, axes, source, licence
    FOLDER/rest/SUBJECT.obj       one body at rest a subject; .ply, .npy or .npz as well
    FOLDER/posed/SUBJECT/POSE.obj scans of the same subjects in other poses; optional
    FOLDER/poses.json             their poses, where they are known; optional
    FOLDER/template.json          the topology, unless it is the packaged one
"""

import hashlib
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from fitter.arrays import Pose, Vertices
from fitter.errors import MeshFolderError
from fitter.training.articulation.part_tree import PART_NAMES
from fitter.training.own_bodies.frame import Frame, read_frame
from fitter.training.own_bodies.json_entries import Entries, read_entries
from fitter.training.own_bodies.mesh_files import READERS, read_mesh
from fitter.training.own_bodies.registration import (
    check_axes,
    check_distinct,
    check_edges,
    check_scan_size,
    check_unit,
    check_vertex_count,
)
from fitter.training.own_bodies.template import Template, same_surface
from fitter.training.own_bodies.template_files import BODIES_FILE, TEMPLATE_FILE, read_template

POSES_FILE = "poses.json"
REST_FOLDER = "rest"
POSED_FOLDER = "posed"

DESCRIBING = (".json", ".npy", ".obj", ".ply")
"""Endings of the files beside the meshes: descriptions, and the template with its arrays."""

LEAST_SUBJECTS = 4
"""Three to learn the two axes from that section 4 needs to turn one against the other, and one to
hold out."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PosedScan:
    """A subject in a pose, body frame, metres; ``pose`` is None where nobody has said it."""

    name: str
    subject: int
    vertices: Vertices
    pose: Pose | None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class OwnBodies:
    """What a folder holds.

    Attributes
    ----------
    template
        What the meshes share.
    subjects
        Names, in alphabetical order.
    rest
        (s, m, 3) the subjects at rest, body frame, metres.
    posed
        Scans of the same subjects in other poses.
    source, licence
        The user's own words for the model's header.
    sha256
        Of all files read, names and bytes.
    """

    template: Template
    subjects: tuple[str, ...]
    rest: Float[np.ndarray, "s m 3"]
    posed: tuple[PosedScan, ...]
    source: str
    licence: str
    sha256: str


def read_own_bodies(folder: Path, packaged: Template) -> OwnBodies:
    """Read and check a folder; ``packaged`` is the topology where it describes none.

    Raises
    ------
    MeshFolderError
        For the first fault, with the file and what to do about it.
    """
    entries = read_entries(
        folder / BODIES_FILE,
        remedy="`python -m fitter.training template --meshes FOLDER` writes one to start from.",
    )
    entries.only(("units", "axes", "source", "licence"))
    frame = read_frame(entries)
    source = _statement(entries, "source", "who was scanned, by whom and when")
    licence = _statement(entries, "licence", "under which terms the meshes may be used")
    template = packaged
    if (folder / TEMPLATE_FILE).is_file():
        template = read_template(folder, frame)
        if same_surface(template.mesh, packaged.mesh):
            template = replace(template, name=packaged.name)
    files = _rest_files(folder)
    rest = np.stack([_read_rest(folder, path, template, frame) for path in files.values()])
    places = [_place(folder, path) for path in files.values()]
    check_distinct(places, rest)
    subjects = tuple(files)
    posed = _read_posed(folder, subjects, rest, template, frame)
    return OwnBodies(
        template=template,
        subjects=subjects,
        rest=rest,
        posed=posed,
        source=source,
        licence=licence,
        sha256=_digest(folder),
    )


def _rest_files(folder: Path) -> dict[str, Path]:
    """By subject, in alphabetical order."""
    files: dict[str, Path] = {}
    for path in _mesh_files(folder / REST_FOLDER):
        if path.stem in files:
            raise MeshFolderError(
                place=_place(folder, path),
                reason=f"is a second file of {path.stem}, beside {files[path.stem].name}",
                remedy="Keep one file a subject.",
            )
        files[path.stem] = path
    if len(files) < LEAST_SUBJECTS:
        raise MeshFolderError(
            place=f"{REST_FOLDER}/",
            reason=f"holds {len(files)} bodies, expected {LEAST_SUBJECTS} at the very least",
            remedy=f"Put one mesh a subject there: {', '.join(READERS)}.",
        )
    return files


def _mesh_files(folder: Path) -> list[Path]:
    if not folder.is_dir():
        return []
    return sorted(
        path for path in folder.iterdir() if path.is_file() and path.suffix.lower() in READERS
    )


def _read_rest(folder: Path, path: Path, template: Template, frame: Frame) -> Vertices:
    place = _place(folder, path)
    mesh = read_mesh(path, place=place)
    check_vertex_count(place, mesh, template)
    check_edges(place, mesh.vertices, template)
    check_axes(place, mesh.vertices, template, frame)
    check_unit(place, mesh.vertices, frame)
    return frame.to_body(mesh.vertices)


def _read_posed(
    folder: Path,
    subjects: tuple[str, ...],
    rest: Float[np.ndarray, "s m 3"],
    template: Template,
    frame: Frame,
) -> tuple[PosedScan, ...]:
    poses = _read_poses(folder, frame)
    scans: list[PosedScan] = []
    root = folder / POSED_FOLDER
    for owner in sorted(root.iterdir()) if root.is_dir() else ():
        if owner.is_file() and owner.suffix.lower() in READERS:
            raise MeshFolderError(
                place=_place(folder, owner),
                reason="lies beside the subjects' folders",
                remedy=f"Put it into {POSED_FOLDER}/SUBJECT/.",
            )
        files = _mesh_files(owner)
        if files and owner.name not in subjects:
            raise MeshFolderError(
                place=_place(folder, owner),
                reason=f"has no body at rest of that name in {REST_FOLDER}/",
                remedy="Give the subject's mesh at rest: the pose is learned as the difference.",
            )
        for path in files:
            place = _place(folder, path)
            mesh = read_mesh(path, place=place)
            check_vertex_count(place, mesh, template)
            check_edges(place, mesh.vertices, template)
            subject = subjects.index(owner.name)
            vertices = frame.to_body(mesh.vertices)
            check_scan_size(place, vertices, rest[subject], template.mesh.triangles)
            name = f"{owner.name}/{path.stem}"
            pose = poses.pop(name, poses.get(path.stem))
            scans.append(PosedScan(name=name, subject=subject, vertices=vertices, pose=pose))
    used = {scan.name.partition("/")[2] for scan in scans}
    for name in poses:
        if name not in used:
            raise MeshFolderError(
                place=f"{POSES_FILE}: {name}",
                reason=f"is the pose of no file in {POSED_FOLDER}/",
                remedy="Name poses as the files are named: POSE, or SUBJECT/POSE.",
            )
    return tuple(scans)


def _read_poses(folder: Path, frame: Frame) -> dict[str, Pose]:
    path = folder / POSES_FILE
    if not path.is_file():
        return {}
    entries = read_entries(path, remedy="Leave it out to have the poses solved for.")
    return {name: _pose(entries.object(name), frame) for name in entries.values}


def _pose(entries: Entries, frame: Frame) -> Pose:
    entries.only(PART_NAMES)
    pose = np.zeros((len(PART_NAMES), 3))
    for part, name in enumerate(PART_NAMES):
        if name not in entries.values:
            continue
        vector = entries.get(name, list)
        if len(vector) != 3 or not all(_is_finite(value) for value in vector):
            entries.fail(
                name,
                f"is {vector}, expected three numbers",
                "Write the rotation vector relative to the parent part, radians.",
            )
        pose[part] = vector
    return frame.turned(pose)


def _is_finite(value: object) -> bool:
    return isinstance(value, int | float) and bool(np.isfinite(value))


def _statement(entries: Entries, name: str, wanted: str) -> str:
    text = entries.get(name, str).strip()
    if not text:
        entries.fail(name, "is empty", f"Write {wanted}: the model file's header repeats it.")
    return text


def _digest(folder: Path) -> str:
    """SHA-256 over names and contents of whatever may be read; other files may come and go."""
    meshes = (
        path
        for pattern in (f"{REST_FOLDER}/*", f"{POSED_FOLDER}/*/*")
        for path in folder.glob(pattern)
        if path.suffix.lower() in READERS
    )
    described = (path for path in folder.iterdir() if path.suffix.lower() in DESCRIBING)
    digest = hashlib.sha256()
    for path in sorted((*described, *meshes)):
        digest.update(f"{_place(folder, path)}\0{path.stat().st_size}\0".encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()


def _place(folder: Path, path: Path) -> str:
    return path.relative_to(folder).as_posix()
