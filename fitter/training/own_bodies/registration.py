"""Whether a mesh is a body registered to the template: what real folders get wrong, one by one.

Checks run from what needs no trust in the others to what does: vertices, triangles, edge lengths
(which know no unit and no axes), axes, unit, side. The first that fails names its cause.
"""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float

from fitter.arrays import Triangles, Vertices
from fitter.body.model_checks import HEIGHT_RANGE_M
from fitter.body.skeleton import regress
from fitter.errors import MeshFolderError
from fitter.training.articulation.part_tree import part_index
from fitter.training.own_bodies.frame import METRES, Frame, axes_entry
from fitter.training.own_bodies.mesh_files import MeshFile
from fitter.training.own_bodies.template import Template
from fitter.vocabulary.measurements import LEAST_HEIGHT_M, MOST_HEIGHT_M

STRANGE_RATIO = 2.0
STRANGE_SHARE = 0.1
"""An edge this many times longer or shorter than the template's, against the body's median, is
strange; more than this share of them, and the mesh is no registration. Of 480 registered bodies of
body mass index 16 to 42 the worst has 0.6 % strange edges; with its vertices numbered from one
instead of zero it has 51 %."""

ALIGNED = 0.8
"""Cosine within which the body's own directions must keep to axes: 37 degrees."""

SAME_M = 5e-5
"""Two subjects whose vertices lie this near to each other on average are one: twice the rounding of
a text file, a hundredth of the least difference between two people."""


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
    other = np.flatnonzero(~_same_triangles(mesh.triangles, triangles))
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


def check_axes(place: str, raw: Vertices, template: Template, frame: Frame) -> None:
    """Refuse a body at rest that does not stand along the declared axes, or is mirrored.

    ``raw`` are its vertices in the file's own axes.
    """
    found = own_directions(raw, template)
    turned = found @ frame.axes.T
    if np.linalg.det(found) < 0.0:
        raise MeshFolderError(
            place=place,
            reason="is a mirror image: the person's left is on the right",
            remedy="Export it right-handed, or multiply one axis by -1; turning it does not help.",
        )
    if (np.diag(turned) >= ALIGNED).all():
        return
    strongest = np.sort(np.abs(found), axis=1)[:, -1]
    if (strongest < ALIGNED).any():
        raise MeshFolderError(
            place=place,
            reason="stands askew: its left, up and forward are "
            + ", ".join(f"({x:.2f} {y:.2f} {z:.2f})" for x, y, z in found),
            remedy="Turn the body so that these lie along axes.",
        )
    entry = ", ".join(f'"{name}": "{axis}"' for name, axis in axes_entry(found).items())
    raise MeshFolderError(
        place=place,
        reason=f"stands along other axes than bodies.json declares: {{{entry}}}",
        remedy="Write these there if all files are alike; otherwise turn this one.",
    )


def check_unit(place: str, raw: Vertices, frame: Frame) -> None:
    """Refuse a body that is no person's size in the declared unit; ``raw`` as in the file."""
    extent = float(np.ptp(raw, axis=0).max())
    low, high = HEIGHT_RANGE_M
    if low <= METRES[frame.unit] * extent <= high:
        return
    likely = [
        unit
        for unit, metres in METRES.items()
        if LEAST_HEIGHT_M <= metres * extent <= MOST_HEIGHT_M
    ]
    raise MeshFolderError(
        place=place,
        reason=f"is {extent:.4g} {frame.unit} high or wide, expected a person"
        + (f'; with "units": "{likely[0]}" it would be one' if likely else ""),
        remedy="Declare the unit in bodies.json; all files of a folder share it.",
    )


def check_scan_size(place: str, vertices: Vertices, rest: Vertices, triangles: Triangles) -> None:
    """Refuse a posed scan that is another size than its subject at rest, or turned inside out."""
    ratio = float(np.median(_edge_lengths(vertices, triangles) / _edge_lengths(rest, triangles)))
    if not 0.8 < ratio < 1.25:
        raise MeshFolderError(
            place=place,
            reason=f"is {ratio:.3g} times as large as its subject at rest",
            remedy="Export both in the unit that bodies.json declares.",
        )
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    if np.einsum("fi,fi->", a, np.cross(b, c)) <= 0.0:
        raise MeshFolderError(
            place=place,
            reason="is a mirror image: its surface faces inward",
            remedy="Export it right-handed, or multiply one axis by -1.",
        )


def check_distinct(places: Sequence[str], rest: Float[np.ndarray, "s m 3"]) -> None:
    """Refuse two files of one body: it would count twice, or be trained on and tested with."""
    flat = (rest - rest.mean(axis=1, keepdims=True)).reshape(len(rest), -1)
    flat = flat - flat.mean(axis=0)
    inner = flat @ flat.T
    squared = np.diag(inner)[:, None] + np.diag(inner)[None] - 2.0 * inner
    squared[np.tril_indices(len(rest))] = np.inf
    first, second = np.unravel_index(np.argmin(squared), squared.shape)
    if squared[first, second] < rest.shape[1] * SAME_M**2:
        raise MeshFolderError(
            place=places[int(second)],
            reason=f"is the same body as {places[int(first)]}",
            remedy="Remove one of them; scans of one person in other poses belong in posed/.",
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


def _same_triangles(first: Triangles, second: Triangles) -> Bool[np.ndarray, " f"]:
    """Whether corners agree, whichever comes first."""
    return np.any(
        [(np.roll(first, turn, axis=1) == second).all(axis=1) for turn in range(3)], axis=0
    )
