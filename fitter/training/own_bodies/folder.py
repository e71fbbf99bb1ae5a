"""A folder of registered meshes: which files it holds, read and checked.

::

    FOLDER/bodies.json            source, licence
    FOLDER/rest/SUBJECT.obj       one body at rest a subject; .npy as well
    FOLDER/posed/SUBJECT/POSE.obj scans of the same subjects in other poses; optional
    FOLDER/template.npz           the topology, unless it is the packaged one

All meshes are in metres and the body frame: x to the person's left, y up, z forward. Checks of a
mesh run from what needs no trust in the others to what does: vertices, triangles, edge lengths
(which know no unit and no axes), axes, unit. The first that fails names its cause.
"""

import json
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from fitter.arrays import Triangles, Vertices
from fitter.body.model import regress
from fitter.errors import MeshFolderError
from fitter.training.articulation.parts import part_index
from fitter.training.own_bodies.mesh_files import READERS, MeshFile, read_mesh
from fitter.training.own_bodies.template import (
    TEMPLATE_FILE,
    Template,
    read_template,
    same_surface,
)

STRANGE_RATIO = 2.0
STRANGE_SHARE = 0.1
"""An edge this many times longer or shorter than the template's, against the body's median, is
strange; more than this share of them, and the mesh is no registration. Of 480 registered bodies of
body mass index 16 to 42 the worst has 0.6 % strange edges; with its vertices numbered from one
instead of zero it has 51 %."""

ALIGNED = 0.8
"""Cosine within which the body's own directions must keep to the frame's: 37 degrees."""


def check_vertex_count(place: str, mesh: MeshFile, template: Template) -> None:
    """Refuse meshes of another size, and of other triangles where they have any of that number."""
    wanted = len(template.vertices)
    if len(mesh.vertices) != wanted:
        raise MeshFolderError(
            place=place,
            reason=f"has {len(mesh.vertices)} vertices, expected {wanted}: {template.name}",
            remedy="Export without merging, splitting or sorting vertices; a mesh that was never "
            "registered to the template must be registered first.",
        )
    triangles = template.mesh.triangles
    if mesh.triangles is None or mesh.triangles.shape != triangles.shape:
        return
    # Corners must agree, whichever comes first.
    turned = [np.roll(mesh.triangles, turn, axis=1) for turn in range(3)]
    same = np.any([(each == triangles).all(axis=1) for each in turned], axis=0)
    other = np.flatnonzero(~same)
    if len(other):
        raise MeshFolderError(
            place=place,
            reason=f"has {len(other)} triangles that are not the template's, the first is "
            f"{other[0]}: {mesh.triangles[other[0]]}, expected {triangles[other[0]]}",
            remedy="Vertices must keep their order and triangles their corners; turned the other "
            "way round they face inward.",
        )


def check_edges(place: str, vertices: Vertices, template: Template) -> None:
    """Refuse meshes whose edges are not those of a body on this template."""
    triangles = template.mesh.triangles
    lengths = _edge_lengths(vertices, triangles)
    ratios = lengths / _edge_lengths(template.vertices, triangles)
    middle = float(np.median(ratios))
    strange = (ratios > STRANGE_RATIO * middle) | (ratios < middle / STRANGE_RATIO)
    if middle == 0.0 or strange.mean() > STRANGE_SHARE:
        raise MeshFolderError(
            place=place,
            reason=f"is not registered to the template: {100.0 * strange.mean():.0f} % of its "
            f"edges are {STRANGE_RATIO:g} times as long or short as there, expected less than "
            f"{100.0 * STRANGE_SHARE:.0f} %",
            remedy="Vertex i must be the same point of the body in every file; look for a program "
            "that sorted the vertices, or counted from another number.",
        )


def check_stance(place: str, vertices: Vertices, template: Template) -> None:
    """Refuse a body at rest that is mirrored, no person's size, or not in the body frame."""
    found = own_directions(vertices, template)
    if np.linalg.det(found) < 0.0:
        raise MeshFolderError(
            place=place,
            reason="is a mirror image: the person's left is on the right",
            remedy="Export it right-handed, or multiply one axis by -1; turning it does not help.",
        )
    if (np.diag(found) < ALIGNED).any():
        directions = ", ".join(f"({x:.1f} {y:.1f} {z:.1f})" for x, y, z in found)
        raise MeshFolderError(
            place=place,
            reason=f"stands along other axes: its left, up and forward are {directions}",
            remedy="Turn it so that they are x, y and z.",
        )
    extent = float(np.ptp(vertices, axis=0).max())
    low, high = HEIGHT_RANGE_M
    if not low <= extent <= high:
        raise MeshFolderError(
            place=place,
            reason=f"is {extent:.4g} m high or wide, expected a person",
            remedy="Write metres: divide millimetres by 1000, centimetres by 100.",
        )


def check_scan_size(place: str, vertices: Vertices, rest: Vertices, triangles: Triangles) -> None:
    """Refuse a posed scan that is another size than its subject at rest, or turned inside out."""
    ratio = float(np.median(_edge_lengths(vertices, triangles) / _edge_lengths(rest, triangles)))
    if not 0.8 < ratio < 1.25:
        raise MeshFolderError(
            place=place,
            reason=f"is {ratio:.3g} times as large as its subject at rest",
            remedy="Write both in metres.",
        )
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    if np.einsum("fi,fi->", a, np.cross(b, c)) <= 0.0:
        raise MeshFolderError(
            place=place,
            reason="is a mirror image: its surface faces inward",
            remedy="Export it right-handed, or multiply one axis by -1.",
        )


def own_directions(vertices: Vertices, template: Template) -> Float[np.ndarray, "3 3"]:
    """A body's left, up and forward as unit rows, in the axes of its vertices."""
    joints = regress(template.mesh.joint_regressor, vertices)
    landmarks = regress(template.mesh.landmarks, vertices)

    def joint(name: str) -> Float[np.ndarray, "3"]:
        return joints[part_index(name)]

    def landmark(name: str) -> Float[np.ndarray, "3"]:
        return landmarks[template.mesh.landmarks.names.index(name)]

    directions = np.stack(
        [
            joint("left_thigh") - joint("right_thigh"),
            joint("neck") - joint("pelvis"),
            landmark("left_toe")
            + landmark("right_toe")
            - landmark("left_heel")
            - landmark("right_heel"),
        ]
    )
    return directions / np.linalg.norm(directions, axis=1, keepdims=True)


def _edge_lengths(vertices: Vertices, triangles: Triangles) -> Float[np.ndarray, " three_f"]:
    corners = vertices[triangles]
    return np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2).reshape(-1)


HEIGHT_RANGE_M = (0.4, 2.6)
"""Vertical extent of a mean body at rest: the smallest child and the tallest person in metres, and
neither in centimetres nor feet."""

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
