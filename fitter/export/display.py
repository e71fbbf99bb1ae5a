"""Pictures to the pixels of a file: sizes, levels, PNG bytes."""

import cv2
import numpy as np
from jaxtyping import Float, UInt8

from fitter.arrays import GreyImage
from fitter.render.camera import Camera

_COMPRESSION = (
    *(cv2.IMWRITE_PNG_COMPRESSION, 1),
    *(cv2.IMWRITE_PNG_STRATEGY, cv2.IMWRITE_PNG_STRATEGY_RLE),
)
"""zlib's fastest level, which looks for repeats of one byte alone: three quarters of the time of
level 4, for 4 per cent more bytes on a photograph and as many on drawn pictures."""


def to_levels(display: Float[np.ndarray, "..."]) -> UInt8[np.ndarray, "..."]:
    """Display values in [0, 1] to the nearest of 256 levels; what lies beyond is clipped."""
    return np.rint(np.clip(display, 0.0, 1.0) * 255.0).astype(np.uint8)


def png(levels: UInt8[np.ndarray, "h w ..."]) -> bytes:
    """A PNG of (h, w) grey, (h, w, 3) red-green-blue or (h, w, 4) levels with opacity.

    The same input gives the same bytes.
    """
    ordered = levels[:, :, [2, 1, 0, 3][: levels.shape[2]]] if levels.ndim == 3 else levels
    encoded, content = cv2.imencode(".png", ordered, _COMPRESSION)
    if not encoded:
        message = f"OpenCV could not encode a picture of shape {levels.shape}."
        raise RuntimeError(message)
    return content.tobytes()


def block_means(picture: GreyImage, factor: int) -> Float[np.ndarray, "h//{factor} w//{factor}"]:
    """Mean over ``factor`` x ``factor`` blocks: from a supersampled picture to an anti-aliased."""
    shifts = [(row, column) for row in range(factor) for column in range(factor)]
    total = sum(picture[row::factor, column::factor] for row, column in shifts)
    return np.asarray(total) / factor**2


def finer(camera: Camera, factor: int) -> Camera:
    """The camera with every pixel split into ``factor`` x ``factor``."""
    return camera.scaled(factor, width=camera.width * factor, height=camera.height * factor)
