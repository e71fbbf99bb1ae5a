"""A silhouette's outline as closed lines, for drawing."""

import cv2
import numpy as np
from jaxtyping import Float

from fitter.arrays import Mask

FLATTENED_PX = 0.6
"""Corners that stand out less than this from the line through their neighbours are left out."""


def outline_loops(silhouette: Mask) -> tuple[Float[np.ndarray, "_ 2"], ...]:
    """Closed lines round a silhouette and its holes, continuous pixels, longest first.

    They run through the centres of the silhouette's outermost pixels, so that they lie up to half a
    pixel inside it. Filled by the even-odd rule they are the silhouette.
    """
    found, _ = cv2.findContours(silhouette.astype(np.uint8), cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    flattened = [cv2.approxPolyDP(loop, FLATTENED_PX, True)[:, 0, :] for loop in found]
    # Three corners enclose something; fewer are specks of one pixel's width.
    loops = [loop.astype(np.float64) + 0.5 for loop in flattened if len(loop) >= 3]
    return tuple(sorted(loops, key=len, reverse=True))
