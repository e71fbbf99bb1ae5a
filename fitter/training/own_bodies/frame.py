"""Units and axes of a folder's files, as ``bodies.json`` declares them, and the body frame."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import Vertices
from fitter.training.own_bodies.json_entries import Entries

METRES: Mapping[str, float] = {
    "m": 1.0,
    "dm": 0.1,
    "cm": 0.01,
    "mm": 0.001,
    "in": 0.0254,
    "ft": 0.3048,
}

DIRECTIONS = ("left", "up", "forward")
"""The body frame's axes x, y and z: toward the person's left, upward, the way the person faces."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Frame:
    """How coordinates of the files become those of the body frame.

    Attributes
    ----------
    unit
        By :data:`METRES`.
    axes
        (3, 3) a rotation: rows are the person's left, up and forward in the files' axes.
    """

    unit: str
    axes: Float[np.ndarray, "3 3"]

    def to_body(self, vertices: Vertices) -> Vertices:
        """Positions, body frame, metres."""
        return METRES[self.unit] * self.turned(vertices)

    def turned(self, vectors: Float[np.ndarray, "k 3"]) -> Float[np.ndarray, "k 3"]:
        """Directions or rotation vectors in the body frame's axes."""
        return vectors @ self.axes.T


BODY_FRAME = Frame(unit="m", axes=np.eye(3))


def read_frame(entries: Entries) -> Frame:
    """The entries ``units`` and ``axes``.

    Raises
    ------
    MeshFolderError
        If one is missing or says nothing usable.
    """
    unit = entries.get("units", str)
    if unit not in METRES:
        entries.fail("units", f"is {unit!r}", f"Write one of {', '.join(METRES)}.")
    given = entries.object("axes")
    given.only(DIRECTIONS)
    rows = []
    for direction in DIRECTIONS:
        text = given.get(direction, str)
        sign, axis = (text[0], text[1:]) if text[:1] in ("+", "-") else ("+", text)
        if axis not in ("x", "y", "z"):
            given.fail(direction, f"is {text!r}", "Write an axis with its sign, such as +x or -z.")
        rows.append(np.eye(3)["xyz".index(axis)] * (-1.0 if sign == "-" else 1.0))
    axes = np.stack(rows)
    if abs(np.linalg.det(axes)) < 0.5:
        entries.fail("axes", "names an axis twice", "Give each direction an axis of its own.")
    if np.linalg.det(axes) < 0.0:
        entries.fail(
            "axes",
            "describes a left-handed frame, in which bodies are mirror images of themselves",
            "Turn one direction round, or export the meshes right-handed.",
        )
    return Frame(unit=unit, axes=axes)


def axes_entry(axes: Float[np.ndarray, "3 3"]) -> dict[str, str]:
    """Signed axes as ``bodies.json`` names them."""
    strongest = np.argmax(np.abs(axes), axis=1)
    return {
        direction: f"{'-' if row[k] < 0.0 else '+'}{'xyz'[k]}"
        for direction, row, k in zip(DIRECTIONS, axes, strongest, strict=True)
    }
