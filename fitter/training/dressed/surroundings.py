"""Random surroundings: walls, floors, furniture-like shapes, noise, and shadows at the feet."""

import cv2
import numpy as np
from jaxtyping import Float

from fitter.arrays import Mask
from fitter.training.dressed.cloths import Rgb, cloth_colour, skin_colour

Light = Float[np.ndarray, "s s 3"]


def surroundings(rng: np.random.Generator, size: int) -> Light:
    """Linear light behind a person: of any colour, skin's among them, and brightness."""
    down, across = np.mgrid[0:size, 0:size] / size
    shown = np.broadcast_to(_shown(rng), (size, size, 3)).copy()
    other = shown[0, 0] * rng.uniform(0.5, 1.4) if rng.random() < 0.7 else _shown(rng)
    ways = np.cos(rng.uniform(0.0, 2.0 * np.pi, 2))
    shown += (other - shown) * np.clip(ways[0] * across + ways[1] * down, 0.0, 1.0)[..., None]
    if rng.random() < 0.75:
        shown = _with_floor(shown, down + rng.normal(0.0, 0.02) * across, rng)
    for _ in range(rng.choice([0, 0, 3, 8, 20])):
        there = _shape(size, rng)
        often, way = rng.uniform(10.0, 200.0), rng.uniform(0.0, 2.0 * np.pi)
        stripes = np.sin(often * (across * np.cos(way) + down * np.sin(way)))
        texture = 1.0 + rng.uniform(0.0, 0.3) * stripes
        shown = np.where(there[..., None], _shown(rng) * texture[..., None], shown)
    if rng.random() < 0.5:
        step = int(rng.choice([2, 6, 20, 60]))
        cells, channels = size // step + 2, 3 if rng.random() < 0.3 else 1
        coarse = rng.normal(size=(cells, cells, channels)).astype(np.float32)
        grain = cv2.resize(coarse, (size, size), interpolation=cv2.INTER_CUBIC)
        shown = shown * np.exp(rng.uniform(0.03, 0.4) * grain.reshape(size, size, channels))
    if rng.random() < 0.35:
        shown = cv2.GaussianBlur(shown, (0, 0), rng.uniform(1.0, 9.0))
    light = np.clip(shown, 0.0, 1.0) ** 2.2 * rng.uniform(0.5, 1.5)
    against_the_light = rng.random() < 0.08
    return 3.0 * light + 0.5 if against_the_light else light


def with_shadow(light: Light, person: Mask, rng: np.random.Generator) -> Light:
    """Half of the time a soft shadow under a person's feet."""
    if rng.random() < 0.5 or not person.any():
        return light
    lowest = int(np.flatnonzero(person.any(axis=1))[-1])
    middle = int(np.flatnonzero(person[max(lowest - 15, 0) :].any(axis=0)).mean())
    shadow = np.zeros(person.shape, np.float32)
    centre = middle + int(rng.normal(0.0, 8.0)), lowest - 2
    axes = int(rng.uniform(20.0, 65.0)), int(rng.uniform(3.0, 13.0))
    cv2.ellipse(shadow, centre, axes, 0, 0, 360, 1.0, -1)
    shadow = cv2.GaussianBlur(shadow, (0, 0), rng.uniform(1.5, 6.0))
    return light * (1.0 - rng.uniform(0.2, 0.7) * shadow)[..., None]


def _with_floor(shown: Light, down: Float[np.ndarray, "s s"], rng: np.random.Generator) -> Light:
    edge, colour = rng.uniform(0.62, 0.93), _shown(rng)
    nearer = 0.8 + 0.4 * (down - edge) / (1.0 - edge)
    shown = np.where((down > edge)[..., None], colour * nearer[..., None], shown)
    if rng.random() < 0.4:
        skirting = np.abs(down - edge) < rng.uniform(0.004, 0.02)
        shown = np.where(skirting[..., None], _shown(rng), shown)
    return shown


def _shape(size: int, rng: np.random.Generator) -> Mask:
    """A box, an ellipse or a line."""
    there = np.zeros((size, size), np.uint8)
    x, y = rng.integers(-size // 8, size, 2).tolist()
    width, height = np.exp(rng.uniform(np.log(5.0), np.log(size), 2)).astype(int).tolist()
    kind = rng.random()
    if kind < 0.5:
        cv2.rectangle(there, (x, y), (x + width, y + height), 1, -1)
    elif kind < 0.75:
        axes, angle = (width // 2 + 1, height // 2 + 1), rng.uniform(0.0, 180.0)
        cv2.ellipse(there, (x, y), axes, angle, 0, 360, 1, -1)
    else:
        end = rng.integers(0, size, 2).tolist()
        cv2.line(there, (x, y), end, 1, int(rng.integers(1, 8)))
    return there > 0


def _shown(rng: np.random.Generator) -> Rgb:
    """A colour in display values."""
    if rng.random() < 0.6:
        return cloth_colour(rng) ** (1.0 / 2.2)
    return np.clip(skin_colour(rng) ** (1.0 / 2.2) * rng.uniform(0.7, 1.3), 0.0, 1.0)
