"""Display values and linear light.

A file stores *display* values: sRGB-coded, roughly even to the eye. Edges, GrabCut and pictures
for people use these. Eq. 1 adds light, so shading, albedo and any averaging of pixels use *linear*
values, and the fit's intensity is their luminance. Both are in [0, 1] and never rescaled again.
"""

import numpy as np
from jaxtyping import Float, UInt8

from fitter.arrays import GreyImage, Image

LUMINANCE_WEIGHTS = np.array([0.2126, 0.7152, 0.0722])
"""Of linear sRGB (ITU-R BT.709)."""


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
