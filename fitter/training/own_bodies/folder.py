"""A folder of registered meshes: which files it holds, read and checked.

::

    FOLDER/bodies.json            source, licence
    FOLDER/rest/SUBJECT.obj       one body at rest a subject; .npy as well
    FOLDER/posed/SUBJECT/POSE.obj scans of the same subjects in other poses; optional
    FOLDER/template.npz           the topology, unless it is the packaged one

All meshes are in metres and the body frame: x to the person's left, y up, z forward.
"""

import json
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from fitter.arrays import Vertices
from fitter.errors import MeshFolderError
from fitter.training.own_bodies.mesh_files import READERS, read_mesh
from fitter.training.own_bodies.registration import (
    check_edges,
    check_scan_size,
    check_stance,
    check_vertex_count,
)
from fitter.training.own_bodies.template import (
    TEMPLATE_FILE,
    Template,
    read_template,
    same_surface,
)

BODIES_FILE = "bodies.json"
REST_FOLDER = "rest"
POSED_FOLDER = "posed"

LEAST_SUBJECTS = 4
"""Three to learn the two axes from that section 4 needs to turn one against the other, and one to
hold out."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Scan:
    """A subject in a pose that nobody has said, body frame, metres."""

    subject: int
    vertices: Vertices


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class OwnBodies:
    """Registered bodies.

    Attributes
    ----------
    template
        What the meshes share.
    subjects
        Names, in alphabetical order.
    rest
        (s, m, 3) the subjects at rest, body frame, metres.
    scans
        The same subjects in other poses.
    source, licence
        The user's own words for the model's header.
    """

    template: Template
    subjects: tuple[str, ...]
    rest: Float[np.ndarray, "s m 3"]
    scans: tuple[Scan, ...]
    source: str
    licence: str


def read_own_bodies(folder: Path, packaged: Template) -> OwnBodies:
    """Read and check a folder; ``packaged`` is the topology where it describes none.

    Raises
    ------
    MeshFolderError
        For the first fault, with the file and what to do about it.
    """
    source, licence = _read_statements(folder / BODIES_FILE)
    template = packaged
    if (folder / TEMPLATE_FILE).is_file():
        template = read_template(folder / TEMPLATE_FILE)
        if same_surface(template.mesh, packaged.mesh):
            mesh = replace(template.mesh, mirror=packaged.mesh.mirror)
            template = replace(template, name=packaged.name, mesh=mesh)
    files = _rest_files(folder)
    meshes: list[Vertices] = []
    for path in files.values():
        meshes.append(_read_body(folder, path, template))
        check_stance(_place(folder, path), meshes[-1], template)
    rest, subjects = np.stack(meshes), tuple(files)
    return OwnBodies(
        template=template,
        subjects=subjects,
        rest=rest,
        scans=_read_scans(folder, subjects, rest, template),
        source=source,
        licence=licence,
    )


def _read_statements(path: Path) -> tuple[str, str]:
    """Source and licence of the meshes, which the model file's header repeats."""
    try:
        told = json.loads(path.read_text(encoding="utf-8"))
        source, licence = (str(told[name]).strip() for name in ("source", "licence"))
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise MeshFolderError(
            place=path.name,
            reason=f"cannot be read ({error})",
            remedy="`python -m fitter.training template --meshes FOLDER` writes one to fill in.",
        ) from error
    if not (source and licence):
        raise MeshFolderError(
            place=path.name,
            reason="leaves source or licence empty",
            remedy="Write who was scanned, by whom and when, and under which terms the meshes may "
            "be used: the model file's header repeats it.",
        )
    return source, licence


def _rest_files(folder: Path) -> dict[str, Path]:
    """The mesh files at rest by subject, in alphabetical order."""
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


def _read_scans(
    folder: Path, subjects: tuple[str, ...], rest: Float[np.ndarray, "s m 3"], template: Template
) -> tuple[Scan, ...]:
    scans: list[Scan] = []
    root = folder / POSED_FOLDER
    for owner in sorted(root.iterdir()) if root.is_dir() else ():
        if owner.name not in subjects:
            raise MeshFolderError(
                place=_place(folder, owner),
                reason=f"has no body at rest of that name in {REST_FOLDER}/",
                remedy=f"Put scans into {POSED_FOLDER}/SUBJECT/, beside a mesh of the subject at "
                "rest: the pose is learned as the difference.",
            )
        subject = subjects.index(owner.name)
        for path in _mesh_files(owner):
            vertices = _read_body(folder, path, template)
            check_scan_size(_place(folder, path), vertices, rest[subject], template.mesh.triangles)
            scans.append(Scan(subject=subject, vertices=vertices))
    return tuple(scans)


def _read_body(folder: Path, path: Path, template: Template) -> Vertices:
    place = _place(folder, path)
    mesh = read_mesh(path, place=place)
    check_vertex_count(place, mesh, template)
    check_edges(place, mesh.vertices, template)
    return mesh.vertices


def _mesh_files(folder: Path) -> list[Path]:
    paths = sorted(folder.iterdir()) if folder.is_dir() else []
    return [path for path in paths if path.is_file() and path.suffix.lower() in READERS]


def _place(folder: Path, path: Path) -> str:
    return path.relative_to(folder).as_posix()
