"""Points of the skin that no landmark names: where a ray from inside the average body leaves it.

``skin_points.json`` beside this file says from where and in which direction. A ray is cast once a
model, on its mean body in the canonical pose; what it meets is a fixed place on the mesh from then
on, three vertices and their weights, and moves with them. So the points follow shapes smoothly, and
models of any topology have them.
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from fitter.arrays import Triangles, Vector3, Vertices
from fitter.body.model import SparseRows
from fitter.errors import DefinitionError

SKIN_POINTS_PATH = Path(__file__).with_name("skin_points.json")
SKIN_PREFIX = "skin:"

_CORNERS = 3


@dataclass(frozen=True, slots=True, kw_only=True)
class SkinPoint:
    """Point where a ray leaves the skin.

    Attributes
    ----------
    name
        With its prefix, as measurements name it.
    meaning
        The place, in words.
    origin
        Landmarks and joints whose mean the ray starts from.
    level
        Those whose mean height it starts at instead; None for the origin's own.
    direction
        Body frame: x to the person's left, y up, z forward.
    """

    name: str
    meaning: str
    origin: tuple[str, ...]
    level: tuple[str, ...] | None
    direction: tuple[float, float, float]

    @property
    def needs(self) -> tuple[str, ...]:
        """Landmarks and joints it is found by."""
        return self.origin + (self.level or ())


def triple(values: Sequence[float]) -> tuple[float, float, float]:
    """Three numbers of a file, as floats."""
    x, y, z = map(float, values)
    return x, y, z


@cache
def load_skin_points() -> Mapping[str, SkinPoint]:
    """The file's points by name; the file is ours, and tests check it."""
    points = json.loads(SKIN_POINTS_PATH.read_text(encoding="utf-8"))["points"]
    return {
        SKIN_PREFIX + name: SkinPoint(
            name=SKIN_PREFIX + name,
            meaning=entry["meaning"],
            origin=tuple(entry["from"]),
            level=tuple(entry["level"]) if "level" in entry else None,
            direction=triple(entry["direction"]),
        )
        for name, entry in points.items()
    }


def skin_rows(
    points: Sequence[SkinPoint],
    known: Mapping[str, Vector3],
    vertices: Vertices,
    triangles: Triangles,
) -> SparseRows:
    """The points as weighted sums of three vertices each.

    Parameters
    ----------
    points
        Which of them.
    known
        Landmarks and joints by name, on the body.
    vertices, triangles
        The mean body in the canonical pose, body frame, metres.

    Raises
    ------
    DefinitionError
        If a ray meets no skin: the body is not as the points' meanings say.
    """
    found = [_first_exit(point, _origin(point, known), vertices, triangles) for point in points]
    return SparseRows(
        names=tuple(point.name for point in points),
        pointers=np.arange(0, _CORNERS * len(points) + 1, _CORNERS, dtype=np.int32),
        indices=np.array([vertex for corners, _ in found for vertex in corners], dtype=np.int32),
        weights=np.array([weight for _, weights in found for weight in weights], dtype=np.float64),
    )


def _origin(point: SkinPoint, known: Mapping[str, Vector3]) -> Vector3:
    origin = np.mean([known[name] for name in point.origin], axis=0)
    if point.level is not None:
        origin[1] = np.mean([known[name][1] for name in point.level])
    return origin


def _first_exit(
    point: SkinPoint, origin: Vector3, vertices: Vertices, triangles: Triangles
) -> tuple[list[int], list[float]]:
    """Corners and weights of the triangle that a ray meets first (Möller and Trumbore 1997)."""
    a, b, c = (vertices[triangles[:, corner]] for corner in range(_CORNERS))
    direction = np.array(point.direction)
    first, second = b - a, c - a
    across = np.cross(direction, second)
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = 1.0 / np.einsum("fi,fi->f", first, across)
        u = scale * np.einsum("fi,fi->f", origin - a, across)
        turned = np.cross(origin - a, first)
        v = scale * (turned @ direction)
        distance = scale * np.einsum("fi,fi->f", second, turned)
        met = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (distance > 0.0)
    if not met.any():
        message = f"{point.name}: the ray from {', '.join(point.origin)} meets no skin."
        raise DefinitionError(message)
    nearest = int(np.argmin(np.where(met, distance, np.inf)))
    weights = [1.0 - float(u[nearest]) - float(v[nearest]), float(u[nearest]), float(v[nearest])]
    return triangles[nearest].tolist(), weights
