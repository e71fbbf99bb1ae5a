"""The working picture: the original averaged down to a size at which fits are fast and precise."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, UInt8

from fitter.arrays import Image
from fitter.observation import _kernels
from fitter.observation.colour import display_from_linear, linear_from_display

WORKING_PIXELS = 400_000
"""Largest working picture. At 640x480 a pixel is about 4 mm on a standing person, and the contour
is found to a fraction of that; more pixels cost time in every stage and show detail that the body
model does not have."""

_LINEAR_OF_BYTE = linear_from_display(np.arange(256) / 255.0)
_SHARE_OF_BYTE = np.arange(256) / 255.0


@dataclass(frozen=True, slots=True, kw_only=True)
class WorkingSize:
    """``scale`` times the original, in both directions alike, so that pixels stay square.

    Up to one working pixel at the right and lower border is left out, because a whole number of
    pixels at one scale rarely fits; stretching them to fit would shift every point instead.
    """

    width: int
    height: int
    scale: float

    def from_reduced(self, reduction: int) -> "WorkingSize":
        """The same size, made from an original of which one pixel is ``reduction`` on a side."""
        return replace(self, scale=self.scale * reduction)


def working_size(*, width: int, height: int, pixels: int = WORKING_PIXELS) -> WorkingSize:
    """The size to work at, with at most ``pixels`` pixels; a picture is never enlarged."""
    scale = min(1.0, (pixels / (width * height)) ** 0.5)
    return WorkingSize(width=int(width * scale), height=int(height * scale), scale=scale)


def linear_working_picture(
    pixels: UInt8[np.ndarray, "h w 3"], size: WorkingSize
) -> Float[np.ndarray, "h2 w2 3"]:
    """Linear light at the working size, float32: light can be averaged, display values cannot."""
    return _kernels.area_average(pixels, _LINEAR_OF_BYTE, 1.0 / size.scale, size.width, size.height)


def display_working_picture(linear_rgb: Float[np.ndarray, "h w 3"]) -> Image:
    """(h, w, 3) float32 display values of a working picture in linear light."""
    return display_from_linear(linear_rgb).astype(np.float32)


def working_coverage(
    coverage: UInt8[np.ndarray, "h w"], size: WorkingSize
) -> Float[np.ndarray, "h2 w2"]:
    """Share of each working pixel that is foreground, in [0, 1]."""
    shares = _kernels.area_average(
        coverage[:, :, None], _SHARE_OF_BYTE, 1.0 / size.scale, size.width, size.height
    )
    return shares[:, :, 0]
