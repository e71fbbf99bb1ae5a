"""Edge cost map (section 3.3): a thresholded distance transform of image edges, in [0, 1]."""

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Float

from fitter.arrays import GreyImage, Image, Mask, Points2D
from fitter.evidence.sampling import sample

# Canny's thresholds on 8-bit grey after smoothing; its author advises a ratio of 2 to 3. Low enough
# to see an arm in front of the trunk, skin against skin.
_CANNY_LOW, _CANNY_HIGH = 25.0, 70.0
_SMOOTHING_PX = 1.2


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class EdgeCostMap:
    """Cost of a model edge at each pixel: 0 on an image edge, 1 beyond the threshold."""

    cost: GreyImage

    def at(self, points: Points2D) -> Float[np.ndarray, " k"]:
        """Cost at continuous pixels."""
        return sample(self.cost, points)[0]

    def with_gradient_at(self, points: Points2D) -> tuple[Float[np.ndarray, " k"], Points2D]:
        """Cost and its derivative per pixel."""
        return sample(self.cost, points)

    def without(self, region: Mask) -> "EdgeCostMap":
        """The same with no image edge in a region (h, w)."""
        return EdgeCostMap(cost=np.where(region, np.float32(1.0), self.cost))


def edge_cost_map(display: Image, *, threshold_px: float) -> EdgeCostMap:
    """Distance to Canny edges of the picture's display values, truncated at ``threshold_px``.

    Parameters
    ----------
    display
        (h, w, 3) display-encoded values in [0, 1]: edges are sought as people see them.
    threshold_px
        Distance at which an edge no longer attracts.
    """
    grey = cv2.cvtColor(np.ascontiguousarray(display, dtype=np.float32), cv2.COLOR_RGB2GRAY)
    smooth = cv2.GaussianBlur(grey, (0, 0), _SMOOTHING_PX)
    levels = np.round(smooth * 255.0).clip(0, 255).astype(np.uint8)
    edges = cv2.Canny(levels, _CANNY_LOW, _CANNY_HIGH, L2gradient=True)
    # The 5 x 5 mask is off by 2 % and takes a quarter of the time; past the threshold all is 1.
    distance = cv2.distanceTransform((edges == 0).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    return EdgeCostMap(cost=(np.minimum(distance, threshold_px) / threshold_px).astype(np.float32))
