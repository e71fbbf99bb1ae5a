"""Sharpness of the person's edges, and the light on them.

Zhuo and Sim, "Defocus map estimation from a single image" (Pattern Recognition, 2011), section 2:
an edge that is blurred with deviation σ and once more with σ₀ loses slope by the ratio
R = sqrt((σ² + σ₀²) / σ²), so that σ = σ₀ / sqrt(R² - 1) whatever its contrast. They carry σ from
edges into surfaces; here the median along the person's edges is enough. Upright and level edges are
looked at apart, for a camera or person that moves blurs only one of the two.
"""

import cv2
import numpy as np
from jaxtyping import Float, UInt8

from fitter.arrays import GreyImage, Mask
from fitter.capture.capture import Capture
from fitter.observation.pixels import LUMINANCE_WEIGHTS, linear_from_display
from fitter.vocabulary.remarks import Code, Remark, Severity, remark, unchecked

REBLUR_PX = 1.0
"""σ₀."""

DENOISING_PX = 0.7
"""Blur before slopes are taken, against noise; what it adds is subtracted again."""

LEAST_SLOPE = 0.03
"""Slope of an edge in a pixel, as a share of the contrast within the person."""

LEAST_EDGES = 30
"""Fewest pixels of edges from which blur is estimated."""

HARMFUL_PX = 1.9
"""Deviation, working pixels: 0.7 to 1.1 of sharp pictures, 1.9 to 2.2 of the same blurred by 2
pixels. Then hips of the tuning half come out 0.8 cm and weights 1.2 kg smaller than sharp."""

BLOCKING_PX = 5.0
"""Blurred by 6 pixels, errors of waists and chests grow by two thirds."""

COARSE_PX = 2.5
"""From here on a picture of half the size tells more: the slopes are near the steps of 8 bits."""

LEAST_SIDE_PX = 64
"""No smaller pictures are looked at."""

RIM_OF_STATURE = 0.01
"""Edges this far outside the person count too: the outline's own."""


def sharpness(capture: Capture) -> Remark | None:
    """Whether the edges of the person, or of the whole picture if nobody was found, are sharp."""
    stature_px = capture.stature_px
    reach = 1 if stature_px is None else max(2, round(RIM_OF_STATURE * stature_px))
    region = cv2.dilate(
        capture.region.astype(np.uint8), np.ones((2 * reach + 1, 2 * reach + 1), np.uint8)
    )
    grey = cv2.cvtColor(capture.picture, cv2.COLOR_RGB2GRAY).astype(np.float32) / 255.0
    blur_px = blur_of_edges(grey, region > 0)
    if blur_px is None:
        return unchecked(Code.BLURRED, "There are too few clear edges to judge by.")
    if blur_px < HARMFUL_PX:
        return None
    on_body = (
        f", {1000.0 * capture.height_m * blur_px / stature_px:.0f} mm on the body,"
        if stature_px is not None and capture.shows_somebody
        else ""
    )
    return remark(
        Code.BLURRED,
        f"Edges are blurred with a standard deviation of {blur_px / capture.scale:.1f} "
        f"pixels{on_body} where sharp ones have at most "
        f"{HARMFUL_PX / capture.scale:.1f}.",
        severity=Severity.BLOCKS if blur_px >= BLOCKING_PX else Severity.HARMS,
    )


def blur_of_edges(grey: GreyImage, region: Mask) -> float | None:
    """Standard deviation of the blur of a region's edges, pixels; None if there are too few.

    Of upright and level edges the greater median.

    Parameters
    ----------
    grey
        (h, w) brightness in [0, 1].
    region
        (h, w) where edges count.
    """
    fine = _blur(grey, region)
    if (fine is not None and fine < COARSE_PX) or min(grey.shape) < 2 * LEAST_SIDE_PX:
        return fine
    height, width = grey.shape[0] // 2, grey.shape[1] // 2
    half = cv2.resize(
        grey[: 2 * height, : 2 * width], (width, height), interpolation=cv2.INTER_AREA
    )
    coarse = blur_of_edges(half, region[: 2 * height : 2, : 2 * width : 2])
    return fine if coarse is None else max(fine or 0.0, 2.0 * coarse)


def _blur(grey: GreyImage, region: Mask) -> float | None:
    """The same at one size."""
    if not region.any():
        return None
    low, high = np.percentile(grey[region], [5.0, 95.0])
    smooth = cv2.GaussianBlur(grey, (0, 0), DENOISING_PX)
    across, down = _gradient(smooth)
    slope = np.hypot(across, down)
    again = np.hypot(*_gradient(cv2.GaussianBlur(smooth, (0, 0), REBLUR_PX)))
    crest = slope >= cv2.dilate(slope, np.ones((3, 3), np.uint8))
    edges = region & crest & (slope > max(LEAST_SLOPE * float(high - low), 1e-3))
    steep = np.abs(across) > np.abs(down)
    found = [
        _median_blur(slope[kind], again[kind])
        for kind in (edges & steep, edges & ~steep)
        if np.count_nonzero(kind) >= LEAST_EDGES
    ]
    return max(found, default=None)


def _median_blur(slopes: Float[np.ndarray, " e"], again: Float[np.ndarray, " e"]) -> float:
    """Median blur of edges of these slopes, and these when blurred once more, pixels."""
    ratio = np.maximum(slopes / np.maximum(again, 1e-9), 1.0 + 1e-6).astype(np.float64)
    variance = REBLUR_PX**2 / (ratio**2 - 1.0)
    return float(np.sqrt(max(float(np.median(variance)) - DENOISING_PX**2, 0.0)))


def _gradient(grey: GreyImage) -> tuple[GreyImage, GreyImage]:
    """Slopes to the right and down, per pixel."""
    across = cv2.Sobel(grey, cv2.CV_32F, 1, 0, ksize=3) / 8.0
    return across, cv2.Sobel(grey, cv2.CV_32F, 0, 1, ksize=3) / 8.0


DARKEST = 0.025
"""Least 90th percentile of the person's luminance, linear, of 1. Of the tuning pictures it is 0.17
to 0.74, and 0.07 of the darkest skin; with a twentieth of the light errors of hips grow by half and
of weights by a quarter."""

BURNT = 253
"""Value of a channel, of 255, from which there may have been more light than it shows."""

MOST_BURNT = 0.4
"""Largest share of the person's pixels that are burnt out. Of the tuning pictures it is 0.06 at
most, with three times the light 0.05 to 0.7; then errors of waist and weight grow by a sixth."""

_LINEAR_OF_BYTE = linear_from_display(np.arange(256) / 255.0)


def darkness(capture: Capture) -> Remark | None:
    """Whether even the brighter parts of the person, or of the picture, are dark."""
    luminance = bright_luminance(capture.picture[capture.region])
    if luminance >= DARKEST:
        return None
    return remark(
        Code.TOO_DARK,
        f"The brighter parts of the person have {100.0 * luminance:.1f} % of the light that a "
        f"picture can show, and {100.0 * DARKEST:.1f} % is the least.",
        severity=Severity.HARMS,
    )


def brightness(capture: Capture) -> Remark | None:
    """Whether much of the person is burnt out."""
    share = burnt_share(capture.picture[capture.region])
    if share < MOST_BURNT:
        return None
    return remark(
        Code.TOO_BRIGHT,
        f"{100.0 * share:.0f} % of the person are burnt out, and {100.0 * MOST_BURNT:.0f} % is "
        "the most.",
        severity=Severity.HARMS,
    )


def bright_luminance(pixels: UInt8[np.ndarray, "k 3"]) -> float:
    """The 90th percentile of linear luminance in [0, 1]."""
    return float(np.percentile(_LINEAR_OF_BYTE[pixels] @ LUMINANCE_WEIGHTS, 90.0))


def burnt_share(pixels: UInt8[np.ndarray, "k 3"]) -> float:
    """Share of pixels with a channel that may be cut off."""
    return float(np.mean(pixels.max(axis=1) >= BURNT))
