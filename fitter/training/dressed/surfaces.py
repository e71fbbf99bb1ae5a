"""Surfaces over a body: its own skin moved outward, tubes that hang, uneven blobs."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from jaxtyping import Bool, Float
from scipy.ndimage import gaussian_filter1d, map_coordinates

from fitter.arrays import Triangles, Vector3, Vertices
from fitter.detection.worn_parts import WornPart
from fitter.training.dressed.bodies import StandingBody

NOISE_LATTICE: Final = 16

CHORDS: Final = (2, 4, 7)
"""Bins on either side whose chord a tube bridges: cloth spans hollows."""

LEAST_EASE_M: Final = 0.004


class Places(NamedTuple):
    """Places of a surface: x, y, z at rest, along the arm, and 1 on arms; (k,) each."""

    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    along_arm: np.ndarray
    arm: np.ndarray

    @property
    def points(self) -> Vertices:
        """(k, 3) x, y, z."""
        return np.column_stack(self[:3])

    @property
    def on_arm(self) -> Bool[np.ndarray, " k"]:
        """Whether a place is on an arm."""
        return self.arm > 0.5


Paint = Callable[[Places], Float[np.ndarray, "k 3"]]
"""Linear albedo at places."""

Cut = Callable[[Places], Bool[np.ndarray, " k"]]
"""Whether there is cloth at places."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Layer:
    """A surface, body frame; where surfaces meet, the one of higher ``rank`` lies over the other.

    ``places`` (m, 5) are those of its vertices; ``folds`` is how high its folds are, ``fold_size``
    how long.
    """

    vertices: Vertices
    triangles: Triangles
    places: Float[np.ndarray, "m 5"]
    part: WornPart
    paint: Paint
    rank: float
    keeps: Cut | None = None
    folds: float = 0.0
    fold_size: float = 1.0
    gloss: float = 0.0


class Sheet(NamedTuple):
    """Vertices (k, 3) and triangles."""

    vertices: Vertices
    triangles: Triangles


def noise(
    rng: np.random.Generator, points: Vertices, size_m: float, *, octaves: int = 2
) -> Float[np.ndarray, " k"]:
    """Smooth noise of about unit height with bumps of a size, from a lattice that repeats."""
    total = np.zeros(len(points), np.float32)
    for octave in range(octaves):
        lattice = rng.normal(size=(NOISE_LATTICE,) * 3).astype(np.float32)
        where = ((points + 5.0) / size_m * 2.0**octave).T.astype(np.float32)
        total += 0.5**octave * map_coordinates(lattice, where, order=1, mode="grid-wrap")
    return total


def smooth_step(values: np.ndarray, low: float, high: float) -> np.ndarray:
    """0 below ``low``, 1 above ``high``, smooth between."""
    share = np.clip((values - low) / (high - low), 0.0, 1.0)
    return share * share * (3.0 - 2.0 * share)


def moved_out(
    body: StandingBody, ease_m: Float[np.ndarray, " m"], *, drop_m: float = 0.0, rounds: int = 3
) -> Vertices:
    """The body's skin moved outward by an ease, smoothed over some rounds of neighbours.

    Cloth under the arms and beside the trunk hangs lower by ``drop_m``.
    """
    mean = body.rest.neighbours
    normals, ease = body.normals, ease_m
    for _ in range(4):
        normals = mean @ normals
    normals = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    for _ in range(2):
        ease = mean @ ease
    vertices = body.vertices + normals * ease[:, None]
    if drop_m > 0.0:
        rest = body.rest
        aside = 0.5 * np.clip(1.0 + 6.0 * rest.along_arm, 0.0, 1.0)
        aside *= np.abs(rest.points[:, 0]) > 0.1
        near = np.where(rest.on_arms, np.exp(-np.maximum(rest.along_arm, 0.0) / 0.35), aside)
        vertices[:, 1] -= drop_m * near * np.maximum(0.1 - normals[:, 1], 0.0)
    for _ in range(rounds):
        vertices = 0.5 * (vertices + mean @ vertices)
    return vertices


@dataclass(frozen=True, slots=True, kw_only=True)
class Hang:
    """A tube's cut: ``ease`` (metres by the share of the way down), and how it falls below.

    ``fall`` is how fast it may come nearer below what stands off, ``flare`` how fast it goes out,
    ``waves_m`` the height of its folds at the hem, ``uneven`` the spread of its ease.
    """

    top_m: float
    hem_m: float
    ease: Callable[[np.ndarray], np.ndarray]
    fall: float
    flare: float = 0.0
    waves_m: float = 0.0
    uneven: float = 0.0
    rows: int = 48
    bins: int = 56


def tube(points: Vertices, hang: Hang, rng: np.random.Generator) -> Sheet | None:
    """Rings about points of the body from top to hem; None where there is next to no body."""
    rows, bins = hang.rows, hang.bins
    heights = np.linspace(hang.top_m, hang.hem_m, rows)
    step = heights[0] - heights[1]
    near = (points[:, 1] < hang.top_m + 0.03) & (points[:, 1] > hang.hem_m - 0.04)
    if step <= 0.0 or near.sum() < 50:
        return None
    points = points[near]
    row = np.clip(np.rint((hang.top_m - points[:, 1]) / step).astype(int), 0, rows - 1)
    middle = _middles(points[:, [0, 2]], row, rows)
    radius = _radii(points[:, [0, 2]] - middle[row], row, rows, bins)
    share = np.linspace(0.0, 1.0, rows)[:, None]
    angle = (np.arange(bins) + 0.5) / bins * 2.0 * np.pi - np.pi
    uneven = _smooth(rng.normal(size=(rows, bins)), rows / 5, bins / 12)
    ease = hang.ease(share) * (1.0 + 12.0 * hang.uneven * uneven)
    radius = radius + np.maximum(ease, LEAST_EASE_M)
    for each in range(1, rows):
        radius[each] = np.maximum(radius[each], radius[each - 1] - hang.fall * step)
    radius = radius + hang.flare * share * (hang.top_m - hang.hem_m)
    if hang.waves_m > 0.0:
        number, phase = rng.integers(5, 12), rng.uniform(0.0, 2.0 * np.pi)
        bent = 4.0 * gaussian_filter1d(rng.normal(size=rows), rows / 4)[:, None]
        wave = np.sin(number * angle + phase + bent)
        wave = wave + 0.5 * np.sin((2 * number + 1) * angle + 2.0 * phase)
        radius = radius + hang.waves_m * share * wave
    radius = _smooth(radius, 1.0, 0.8)
    across = middle[:, :1] + radius * np.sin(angle)
    ahead = middle[:, 1:] + radius * np.cos(angle)
    height = np.broadcast_to(heights[:, None], across.shape)
    vertices = np.stack([across, height, ahead], axis=-1).reshape(-1, 3)
    return Sheet(vertices, grid_triangles(rows, bins, closed=True))


def blob(
    centre: Vector3, radii: Vector3, rng: np.random.Generator, *, uneven: float, rows: int = 22
) -> Sheet:
    """An uneven ellipsoid."""
    polar, azimuth = np.meshgrid(
        np.linspace(0.0, np.pi, rows),
        np.linspace(0.0, 2.0 * np.pi, 2 * rows, endpoint=False),
        indexing="ij",
    )
    outward = np.stack(
        [np.sin(polar) * np.sin(azimuth), np.cos(polar), np.sin(polar) * np.cos(azimuth)], axis=-1
    ).reshape(-1, 3)
    far = 1.0 + uneven * noise(rng, outward, 0.7)
    return Sheet(
        centre + outward * radii * far[:, None], grid_triangles(rows, 2 * rows, closed=True)
    )


def loose_places(vertices: Vertices, scale: float = 1.0) -> Float[np.ndarray, "k 5"]:
    """Places of a surface that is no skin: off the arms, as tall as the model at rest."""
    off_arms = np.tile([-1.0, 0.0], (len(vertices), 1))
    return np.column_stack([vertices / scale, off_arms])


def grid_triangles(rows: int, columns: int, *, closed: bool) -> Triangles:
    """Triangles of a grid of rows from above to below, seen from outside.

    Columns run to the person's left in front; ``closed`` joins the last column to the first.
    """
    row, column = np.meshgrid(
        np.arange(rows - 1), np.arange(columns if closed else columns - 1), indexing="ij"
    )
    beside = (column + 1) % columns
    first, second = row * columns + column, row * columns + beside
    below, across = first + columns, second + columns
    return np.concatenate(
        [
            np.stack([first, below, second], axis=-1).reshape(-1, 3),
            np.stack([second, below, across], axis=-1).reshape(-1, 3),
        ]
    )


def _middles(
    plane: Float[np.ndarray, "k 2"], row: np.ndarray, rows: int
) -> Float[np.ndarray, "rows 2"]:
    low, high = np.full((rows, 2), np.inf), np.full((rows, 2), -np.inf)
    np.minimum.at(low, row, plane)
    np.maximum.at(high, row, plane)
    filled = np.flatnonzero(np.isfinite(low[:, 0]))
    middles = [
        np.interp(np.arange(rows), filled, 0.5 * (low[filled, axis] + high[filled, axis]))
        for axis in (0, 1)
    ]
    return gaussian_filter1d(np.stack(middles, axis=1), 1.5, axis=0)


def _radii(
    away: Float[np.ndarray, "k 2"], row: np.ndarray, rows: int, bins: int
) -> Float[np.ndarray, "rows bins"]:
    """Farthest from the middle by row and angle, hollows bridged."""
    angle = np.arctan2(away[:, 0], away[:, 1])
    column = np.floor((angle + np.pi) / (2.0 * np.pi) * bins).astype(int) % bins
    radius = np.full((rows, bins), -1.0)
    for shift in (-1, 0, 1):
        shifted = np.clip(row + shift, 0, rows - 1)
        np.maximum.at(radius, (shifted, column), np.linalg.norm(away, axis=1))
    for each in range(rows):
        filled = np.flatnonzero(radius[each] > 0.0)
        if len(filled) < 3:
            radius[each] = radius[each - 1] if each else 0.1
            continue
        around = np.concatenate([filled - bins, filled, filled + bins])
        radius[each] = np.interp(np.arange(bins), around, np.tile(radius[each, filled], 3))
    for apart in CHORDS:
        chord = 0.49 * (np.roll(radius, apart, 1) + np.roll(radius, -apart, 1))
        radius = np.maximum(radius, chord * np.cos(2.0 * np.pi * apart / bins))
    return _smooth(radius, 0.7, 1.2)


def _smooth(
    rings: Float[np.ndarray, "rows bins"], down: float, around: float
) -> Float[np.ndarray, "rows bins"]:
    rings = gaussian_filter1d(rings, down, axis=0, mode="nearest")
    return gaussian_filter1d(rings, around, axis=1, mode="wrap")
