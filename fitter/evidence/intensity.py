"""Observed intensity for shape from shading: r_i of Eq. 2, and where it can be trusted."""

from dataclasses import dataclass, replace

import cv2
import numpy as np
from jaxtyping import Bool, Float

from fitter.arrays import GreyImage, Image, Mask, Points2D
from fitter.evidence.sampling import sample

# Vertices of trunk and limbs project a few pixels apart; finer detail is texture.
_SMOOTHING_PX = 1.5
# Pixels this near the outline mix person and background.
_RIM_PX = 3
_CLIPPED_DISPLAY_VALUE = 0.985


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class IntensityMap:
    """Linear luminance of the person.

    Attributes
    ----------
    luminance
        (h, w) linear, smoothed within the person.
    trusted
        (h, w) on the person, off its rim, not clipped.
    """

    luminance: GreyImage
    trusted: Mask

    def at(self, points: Points2D) -> Float[np.ndarray, " k"]:
        """Luminance at continuous pixels, linearly interpolated."""
        return sample(self.luminance, points)[0]

    def with_gradient_at(self, points: Points2D) -> tuple[Float[np.ndarray, " k"], Points2D]:
        """Luminance and its derivative per pixel."""
        return sample(self.luminance, points)

    def trusted_at(self, points: Points2D) -> Bool[np.ndarray, " k"]:
        """Whether the pixel that holds each point can be trusted; points lie in the picture."""
        height, width = self.trusted.shape
        columns = np.clip(points[:, 0].astype(int), 0, width - 1)
        rows = np.clip(points[:, 1].astype(int), 0, height - 1)
        return self.trusted[rows, columns]

    def without(self, region: Mask) -> "IntensityMap":
        """The same with nothing to trust in a region (h, w)."""
        return replace(self, trusted=self.trusted & ~region)


def intensity_map(luminance: GreyImage, display: Image, mask: Mask) -> IntensityMap:
    """Prepare the person's luminance.

    Smoothing is normalised by the mask: the background never bleeds into the person.
    """
    inside = mask.astype(np.float32)
    spread = cv2.GaussianBlur(inside, (0, 0), _SMOOTHING_PX)
    smooth = cv2.GaussianBlur(luminance.astype(np.float32) * inside, (0, 0), _SMOOTHING_PX)
    smooth = np.where(mask, smooth / np.maximum(spread, 1e-6), luminance).astype(np.float32)
    region = np.ascontiguousarray(mask).view(np.uint8)
    depth = cv2.distanceTransform(region, cv2.DIST_L2, cv2.DIST_MASK_5)
    clipped = (display >= _CLIPPED_DISPLAY_VALUE).any(axis=2)
    return IntensityMap(luminance=smooth, trusted=(depth > _RIM_PX) & ~clipped)
