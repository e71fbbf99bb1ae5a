"""From linear light to the file a camera would write."""

import io

import numpy as np
from jaxtyping import Float
from PIL import Image as PillowImage

FOCAL_LENGTH_IN_35MM_FILM = 0xA405
EXIF_DIRECTORY = 0x8769
ARTIST, COPYRIGHT = 0x013B, 0x8298

SHOT_NOISE = 0.00012
READ_NOISE = 0.0015
"""Variance of linear light per unit of light, and deviation in the dark: a few grey levels."""


def photograph(
    linear: Float[np.ndarray, "h w 3"],
    *,
    quality: int,
    equivalent_mm: int | None,
    rng: np.random.Generator,
) -> bytes:
    """Add sensor noise, encode for display, compress."""
    deviation = np.sqrt(SHOT_NOISE * np.maximum(linear, 0.0) + READ_NOISE**2)
    noisy = np.clip(linear + deviation * rng.normal(size=linear.shape), 0.0, 1.0)
    display = np.where(
        noisy <= 0.0031308, 12.92 * noisy, 1.055 * np.power(noisy, 1.0 / 2.4) - 0.055
    )
    picture = PillowImage.fromarray(np.rint(255.0 * display).astype(np.uint8))
    exif = PillowImage.Exif()
    exif[ARTIST] = "Maquette"
    exif[COPYRIGHT] = "CC0 1.0"
    if equivalent_mm is not None:
        exif.get_ifd(EXIF_DIRECTORY)[FOCAL_LENGTH_IN_35MM_FILM] = equivalent_mm
    stream = io.BytesIO()
    picture.save(stream, "JPEG", quality=quality, exif=exif, optimize=True)
    return stream.getvalue()
