"""Pixels in display values and in linear light, and their averages in the working picture.

A file stores *display* values: sRGB-coded, roughly even to the eye. Edges, GrabCut and pictures
for people use these. Eq. 1 adds light, so shading, albedo and any averaging of pixels use *linear*
values, and the fit's intensity is their luminance. Both are in [0, 1] and never rescaled again.

The working picture is the original averaged down to a size at which fits are fast and precise.
"""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, UInt8

from fitter.arrays import GreyImage, Image
from fitter.observation import _kernels

LUMINANCE_WEIGHTS = np.array([0.2126, 0.7152, 0.0722])
"""Weights of the channels of linear sRGB (ITU-R BT.709)."""


def linear_from_display(display: Float[np.ndarray, "..."]) -> Float[np.ndarray, "..."]:
    """Decode sRGB (IEC 61966-2-1)."""
    return np.where(
        display <= 0.04045, display / 12.92, ((np.maximum(display, 0.0) + 0.055) / 1.055) ** 2.4
    )


def display_from_linear(linear: Float[np.ndarray, "..."]) -> Float[np.ndarray, "..."]:
    """Encode sRGB (IEC 61966-2-1)."""
    return np.where(
        linear <= 0.0031308,
        linear * 12.92,
        1.055 * np.maximum(linear, 0.0) ** (1.0 / 2.4) - 0.055,
    )


def bytes_of_display(display: Image) -> UInt8[np.ndarray, "h w 3"]:
    """(h, w, 3) display values in 8 bits, as a detector of people takes them."""
    return np.rint(255.0 * display).astype(np.uint8)


def luminance_of(linear_rgb: Image) -> GreyImage:
    """(h, w) relative luminance of linear sRGB."""
    return linear_rgb @ LUMINANCE_WEIGHTS.astype(linear_rgb.dtype)


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
