"""Encoded pictures built for the tests."""

import io
from typing import Any

import numpy as np
from PIL import Image as PillowImage

from fitter.observation.observation import Observation, observe
from fitter.request import Click, View

WIDTH, HEIGHT = 120, 160


def encode(picture: PillowImage.Image, kind: str = "PNG", **options: Any) -> bytes:
    stream = io.BytesIO()
    picture.save(stream, kind, **options)
    return stream.getvalue()


def noise(*, channels: int = 3, seed: int = 0) -> np.ndarray:
    shape = (HEIGHT, WIDTH, channels) if channels > 1 else (HEIGHT, WIDTH)
    return np.random.default_rng(seed).integers(0, 256, shape, dtype=np.uint8)


def smooth() -> np.ndarray:
    """A picture that lossy coders keep to a few grey levels."""
    rows, columns = np.mgrid[:HEIGHT, :WIDTH]
    return np.stack(
        [rows * 255 // HEIGHT, columns * 255 // WIDTH, np.full_like(rows, 90)], axis=-1
    ).astype(np.uint8)


def standing_clicks() -> dict[str, Click]:
    """A person seen from the front in the WIDTH x HEIGHT picture."""
    places = {
        "shoulder": (18, 40), "elbow": (24, 62), "wrist": (28, 80),
        "hip": (10, 82), "knee": (11, 112), "ankle": (12, 140), "eye": (3, 20),
    }  # fmt: skip
    clicks = {"nose": Click(x=60, y=23)}
    for name, (offset, y) in places.items():
        clicks[f"left_{name}"] = Click(x=60 + offset, y=y)
        clicks[f"right_{name}"] = Click(x=60 - offset, y=y)
    return clicks


def view(image: bytes, **changes: Any) -> View:
    return View(**({"image": image, "clicks": standing_clicks()} | changes))


def read(view: View) -> Observation:
    """The picture as a fit reads it that allows ten million pixels."""
    return observe(view, max_pixels=10_000_000)
