"""Maps over pixels: values and slopes between pixels, distances, and what a window holds."""

import cv2
import numpy as np
from jaxtyping import Bool, Float, UInt8

from fitter.arrays import GreyImage, Points2D
from fitter.observation._kernels import bilinear


def sample(values: GreyImage, points: Points2D) -> tuple[Float[np.ndarray, " k"], Points2D]:
    """Values and derivatives (per pixel, x then y) of the bilinear interpolation.

    Pixel centres lie at + 0.5; beyond the outermost centres the map continues unchanged and its
    slope across the border is zero.
    """
    result = np.empty((len(points), 3))
    bilinear(values, np.ascontiguousarray(points, dtype=np.float64), result)
    return result[:, 0], result[:, 1:]


def window_about(
    marked: Bool[np.ndarray, "h w"] | UInt8[np.ndarray, "h w"], *, margin: int
) -> tuple[slice, slice]:
    """The rectangle of what is marked, at least one pixel, and ``margin`` pixels around it."""
    rows, columns = np.flatnonzero(marked.any(axis=1)), np.flatnonzero(marked.any(axis=0))
    return (
        slice(max(0, int(rows[0]) - margin), int(rows[-1]) + 1 + margin),
        slice(max(0, int(columns[0]) - margin), int(columns[-1]) + 1 + margin),
    )


def exact_distances(elsewhere: UInt8[np.ndarray, "h w"]) -> Float[np.ndarray, "h w"]:
    """Euclidean distance of each pixel that is not 0 to the nearest that is 0, pixels (float32).

    Infinite where there is none.

    OpenCV's exact transform differs in its last bit from one memory layout to the next, and a fit
    that begins with another bit may end in another minimum. Squares of distances between pixels
    are whole numbers, so rounding them gives one answer, up to distances of 2,000 pixels.
    """
    if elsewhere.all():
        return np.full(elsewhere.shape, np.inf, dtype=np.float32)
    distances = cv2.distanceTransform(elsewhere, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    return np.sqrt(np.rint(distances * distances))
