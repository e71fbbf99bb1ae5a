"""A pinhole camera with square pixels."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.vocabulary.outcomes import FocalLengthSource as FocalLengthSource


@dataclass(frozen=True, slots=True, kw_only=True)
class Camera:
    """Pinhole camera, camera frame in OpenCV axes, metres; image in continuous pixels.

    ``centre_x``, ``centre_y`` is the principal point: the picture's middle unless known otherwise.
    """

    focal_length_px: float
    centre_x: float
    centre_y: float
    width: int
    height: int

    def project(self, points: Float[np.ndarray, "... 3"]) -> Float[np.ndarray, "... 2"]:
        """Project camera-frame points (metres, z > 0) to continuous pixels."""
        scale = self.focal_length_px / points[..., 2]
        return np.stack(
            [points[..., 0] * scale + self.centre_x, points[..., 1] * scale + self.centre_y],
            axis=-1,
        )

    def pull_back(
        self, points: Float[np.ndarray, "... 3"], directions: Float[np.ndarray, "... 2"]
    ) -> Float[np.ndarray, "... 3"]:
        """Derivative by camera-frame points of their projections' components along directions.

        For image derivatives g (per pixel) at the projections of ``points`` this is gᵀ ∂u/∂X, per
        metre.
        """
        scale = self.focal_length_px / points[..., 2]
        sideways = directions * scale[..., None]
        depth = -(sideways[..., 0] * points[..., 0] + sideways[..., 1] * points[..., 1])
        return np.concatenate([sideways, (depth / points[..., 2])[..., None]], axis=-1)

    def rays(self, pixels: Float[np.ndarray, "... 2"]) -> Float[np.ndarray, "... 3"]:
        """Rays through continuous pixels, scaled so that z = 1."""
        x = (pixels[..., 0] - self.centre_x) / self.focal_length_px
        y = (pixels[..., 1] - self.centre_y) / self.focal_length_px
        return np.stack([x, y, np.ones_like(x)], axis=-1)

    def scaled(self, factor: float, *, width: int, height: int) -> "Camera":
        """The same camera on a picture resampled by ``factor`` to ``width`` x ``height``."""
        return Camera(
            focal_length_px=self.focal_length_px * factor,
            centre_x=self.centre_x * factor,
            centre_y=self.centre_y * factor,
            width=width,
            height=height,
        )


FULL_FRAME_DIAGONAL_MM = 43.27
"""EXIF's 35 mm equivalent refers to the diagonal of a 24 x 36 mm frame."""

ASSUMED_FOCAL_LENGTH_MM = 50.0
"""35 mm equivalent used when nothing is known: the classical 'normal' lens, and about what a
painter's viewing distance amounts to. Reported as an assumption."""


def focal_length_px_from_35mm(focal_length_35mm: float, *, width: int, height: int) -> float:
    """Focal length in pixels from a 35 mm equivalent, by the diagonal."""
    return focal_length_35mm / FULL_FRAME_DIAGONAL_MM * float(np.hypot(width, height))
