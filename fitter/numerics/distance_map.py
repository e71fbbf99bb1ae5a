"""Distances in a mask that do not depend on where memory happens to lie."""

import cv2
import numpy as np
from jaxtyping import Float, UInt8


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
