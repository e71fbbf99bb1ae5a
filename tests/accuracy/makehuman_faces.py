"""Faces of MakeHuman's base mesh by group, for the renderer: cavities, eyes and lashes included."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from jaxtyping import Float, Integer

from fitter.training.makehuman.meshes import makehuman_folder


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Faces:
    """Quads of one group over the source vertices, and over the texture coordinates."""

    quads: Integer[np.ndarray, "q 4"]
    uv_quads: Integer[np.ndarray, "q 4"]


@cache
def faces_of_group(group: str) -> Faces:
    """The faces of ``body``, ``helper-l-eye`` and so on."""
    quads: list[list[int]] = []
    uv_quads: list[list[int]] = []
    current = ""
    for line in _base_file().read_text().splitlines():
        kind, *fields = line.split() or ("",)
        if kind == "g":
            current = fields[0]
        elif kind == "f" and current == group:
            corners = [[int(number) - 1 for number in field.split("/")[:2]] for field in fields]
            quads.append([corner[0] for corner in corners])
            uv_quads.append([corner[1] for corner in corners])
    return Faces(quads=np.array(quads), uv_quads=np.array(uv_quads))


@cache
def texture_coordinates() -> Float[np.ndarray, "u 2"]:
    """All texture coordinates of the base mesh, v upward."""
    lines = _base_file().read_text().splitlines()
    return np.array([line.split()[1:3] for line in lines if line.startswith("vt ")], dtype=float)


def _base_file() -> Path:
    return makehuman_folder() / "3dobjs" / "base.obj"
