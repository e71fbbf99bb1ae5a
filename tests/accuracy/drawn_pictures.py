"""Pictures without a person, drawn from a seed: hills, a disc, a slab, a dog."""

from collections.abc import Callable
from typing import Any

import cv2
import numpy as np
from jaxtyping import Float, UInt8

from fitter.arrays import Mask

Picture = UInt8[np.ndarray, "h w 3"]
Rng = np.random.Generator

Box = tuple[float, float, float, float]
"""Left, top, right and bottom."""

SIZE = (640, 480)
"""Height and width of what is drawn."""


def hills(rng: Rng) -> Picture:
    """Four ridges under a sky."""
    height, width = SIZE
    rows = np.linspace(0.0, 1.0, height)[:, None]
    sky = np.array([110.0, 160.0, 225.0]) + rows[..., None] * rng.uniform(10.0, 90.0, 3)
    picture = np.broadcast_to(sky, (height, width, 3)).copy()
    for index, level in enumerate(np.sort(rng.uniform(0.35, 0.85, 4))):
        along = np.cumsum(rng.normal(0.0, 1.0, width))
        along = cv2.GaussianBlur(along[None], (0, 0), 18.0)[0]
        ridge = level + 0.12 * (along - along.mean()) / (along.std() + 1e-9) * (1.0 - level)
        ground = rows >= ridge[None]
        tone = np.array([40.0, 80.0, 35.0]) * (1.4 - 0.25 * index) + rng.uniform(0.0, 50.0, 3)
        texture = (
            14.0 * smooth_noise(rng, 2.5)[..., None] + 10.0 * smooth_noise(rng, 15.0)[..., None]
        )
        picture = np.where(ground[..., None], tone + texture, picture)
    return coded(picture + rng.normal(0.0, 2.0, picture.shape))


def one_shape(rng: Rng, draw: Callable[[np.ndarray, Box], np.ndarray]) -> tuple[Picture, Box, Mask]:
    """One shape before a wall: picture, box for the points within it, and mask."""
    height, width = SIZE
    centre = np.array([width, height]) * rng.uniform(0.45, 0.55, 2)
    half = np.array([rng.uniform(0.16, 0.4), 0.4]) * [width, height]
    box = (*(centre - half), *(centre + half))
    shape = draw(np.zeros(SIZE, np.uint8), box) > 0
    colours = rng.uniform(30.0, 225.0, (2, 3))
    picture = np.where(shape[..., None], colours[0], colours[1])
    picture = cv2.GaussianBlur(picture, (0, 0), 0.8) + rng.normal(0.0, 2.0, picture.shape)
    rows, columns = np.nonzero(shape)
    tight = (columns.min(), rows.min(), columns.max(), rows.max())
    left, top, right, bottom = (float(each) for each in tight)
    inset = 0.08 * (bottom - top)
    return coded(picture), (left + inset, top + inset, right - inset, bottom - inset), shape


def disc(canvas: np.ndarray, box: Box) -> np.ndarray:
    """A disc in the middle of a box, in place."""
    left, top, right, bottom = box
    centre = round(0.5 * (left + right)), round(0.5 * (top + bottom))
    radius = round(min(0.5 * (bottom - top), 0.45 * SIZE[1]))
    return cv2.circle(canvas, centre, radius, 1, -1)


def slab(canvas: np.ndarray, box: Box) -> np.ndarray:
    """A box, filled, in place."""
    left, top, right, bottom = (round(each) for each in box)
    return cv2.rectangle(canvas, (left, top), (right, bottom), 1, -1)


def dog_picture(
    rng: Rng,
) -> tuple[Picture, dict[str, tuple[float, float]], Mask]:
    """A dog seen from the side: picture, points of its joints by a person's names, and mask."""
    height, width = SIZE
    scale = width * rng.uniform(0.28, 0.36)
    middle = np.array([0.5 * width, 0.52 * height]) + rng.uniform(-15.0, 15.0, 2)
    swing = rng.uniform(-0.08, 0.08, 4)

    def at(x: float, y: float) -> tuple[float, float]:
        return float(middle[0] + scale * x), float(middle[1] + scale * y)

    legs = {
        "left_arm": (at(0.72, 0.15), at(0.72 + swing[0], 0.62), at(0.74 + swing[0], 1.05)),
        "right_arm": (at(0.55, 0.15), at(0.52 + swing[1], 0.62), at(0.5 + swing[1], 1.05)),
        "left_leg": (at(-0.6, 0.12), at(-0.55 + swing[2], 0.62), at(-0.68 + swing[2], 1.05)),
        "right_leg": (at(-0.75, 0.12), at(-0.8 + swing[3], 0.62), at(-0.9 + swing[3], 1.05)),
    }
    shape = np.zeros(SIZE, np.uint8)
    _ellipse(shape, at(0.0, 0.0), (0.85 * scale, 0.3 * scale), 0.0)
    _ellipse(shape, at(0.95, -0.4), (0.3 * scale, 0.22 * scale), 20.0)
    _ellipse(shape, at(1.15, -0.32), (0.22 * scale, 0.11 * scale), 10.0)
    _ellipse(shape, at(0.8, -0.45), (0.09 * scale, 0.22 * scale), 15.0)
    _stroke(shape, (at(0.65, -0.05), at(0.9, -0.4)), 0.3 * scale)
    _stroke(shape, (at(-0.8, -0.1), at(-1.05, -0.35), at(-1.15, -0.65)), 0.09 * scale)
    for leg in legs.values():
        _stroke(shape, leg, 0.15 * scale)
    points = {"nose": at(1.3, -0.32), "left_eye": at(1.0, -0.48), "head_top": at(0.85, -0.62)}
    for limb, joints in legs.items():
        side, kind = limb.split("_")
        names = ("shoulder", "elbow", "wrist") if kind == "arm" else ("hip", "knee", "ankle")
        points |= {f"{side}_{name}": place for name, place in zip(names, joints, strict=True)}
    fur = rng.uniform(30.0, 160.0, 3) + 14.0 * smooth_noise(rng, 2.0)[..., None]
    lawn = np.array([90.0, 150.0, 70.0]) + rng.uniform(-20.0, 60.0, 3)
    ground = lawn + 12.0 * smooth_noise(rng, 5.0)[..., None]
    picture = cv2.GaussianBlur(np.where(shape[..., None] > 0, fur, ground), (0, 0), 0.7)
    inside = {
        name: (min(max(x, 1.0), width - 1.0), min(max(y, 1.0), height - 1.0))
        for name, (x, y) in points.items()
    }
    return coded(picture), inside, shape > 0


def _ellipse(
    canvas: np.ndarray, centre: tuple[float, float], axes: tuple[float, float], degrees: float
) -> None:
    middle = round(centre[0]), round(centre[1])
    cv2.ellipse(canvas, middle, (round(axes[0]), round(axes[1])), degrees, 0, 360, 1, -1)


def _stroke(canvas: np.ndarray, places: tuple[tuple[float, float], ...], width: float) -> None:
    line = np.array([(round(x), round(y)) for x, y in places], np.int32)
    cv2.polylines(canvas, [line], False, 1, max(round(width), 1))


def smooth_noise(rng: Rng, spread: float) -> Float[np.ndarray, "h w"]:
    """Noise of unit variance, correlated over ``spread`` pixels."""
    blurred = cv2.GaussianBlur(rng.normal(0.0, 1.0, SIZE), (0, 0), spread)
    return blurred / blurred.std()


def coded(values: Any) -> Picture:
    """As 8-bit values."""
    return np.clip(np.rint(values), 0, 255).astype(np.uint8)
