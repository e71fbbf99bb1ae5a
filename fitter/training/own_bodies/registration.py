"""Whether a mesh is a body registered to the template: what real folders get wrong, one by one.

Checks run from what needs no trust in the others to what does: vertices, triangles, edge lengths
(which know no unit and no axes), axes, unit. The first that fails names its cause.
"""

import numpy as np
from jaxtyping import Float

from fitter.arrays import Triangles, Vertices
from fitter.body.model import regress
from fitter.body.model_checks import HEIGHT_RANGE_M
from fitter.errors import MeshFolderError
from fitter.training.articulation.parts import part_index
from fitter.training.own_bodies.mesh_files import MeshFile
from fitter.training.own_bodies.template import Template

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
