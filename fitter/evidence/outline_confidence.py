"""Where an outline can be trusted: hardly around hair and hands."""

from collections.abc import Sequence

import cv2
import numpy as np
from jaxtyping import Float

from fitter.arrays import GreyImage

DOUBTFUL_CONFIDENCE = 0.05
"""What is left of an outline's weight in a doubtful region. The model has no hair, and its hands
are relaxed while people's may not be. Two centimetres of hair all around make a head a tenth
larger: with full weight a body leaned forward to bring its head nearer to the camera."""


def outline_confidence(
    height: int, width: int, regions: Sequence[Float[np.ndarray, "_ 2"]], *, margin_px: float
) -> GreyImage:
    """A map of weights, 1 except around each region.

    Parameters
    ----------
    height, width
        Of the picture.
    regions
        Projected vertices of each doubtful part, continuous pixels; their convex hulls count.
    margin_px
        How far around each hull.
    """
    doubtful = np.zeros((height, width), dtype=np.uint8)
    for region in regions:
        # OpenCV counts from pixel centres.
        hull = cv2.convexHull(np.rint(region - 0.5).astype(np.int32))
        cv2.fillConvexPoly(doubtful, hull, 1)
    distance = cv2.distanceTransform(1 - doubtful, cv2.DIST_L2, cv2.DIST_MASK_5)
    near = (distance <= margin_px) if doubtful.any() else np.zeros_like(doubtful, dtype=bool)
    return np.where(near, DOUBTFUL_CONFIDENCE, 1.0).astype(np.float32)
