"""Limbs under scaled orthography: C. J. Taylor, CVIU 80(3), 2000 (the paper's [24]).

A metre anywhere on the body spans ``scale`` pixels, and a limb's relative depth follows from its
foreshortening: (z₁ - z₂)² = L² - (Δu² + Δv²) / scale². Kept for the comparison the paper makes
(Fig. 2b): it has no absolute depth, and bends limbs that perspective enlarges or shrinks.
The result is placed at focal length / scale so that both methods give the same kind of result.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.pose_init.lifting import CrossPieceEnds, LimbEnds
from fitter.render.camera import Camera


@dataclass(frozen=True, slots=True, kw_only=True)
class OrthographicLifting:
    """Taylor's construction; ``scale`` in pixels a metre.

    Taylor's smallest scale that leaves no limb too long is the largest image length / true length
    over the limbs, given by the same limb that fixes the root depth in perspective.
    """

    camera: Camera
    scale: float

    def place(
        self, pixel: Float[np.ndarray, "2"], depth: Float[np.ndarray, "..."]
    ) -> Float[np.ndarray, "... 3"]:
        """The point seen at the pixel, at this depth: x and y do not depend on it."""
        depth = np.asarray(depth, dtype=np.float64)
        x, y = self._plane(pixel)
        return np.stack([np.full_like(depth, x), np.full_like(depth, y), depth], axis=-1)

    def parallel_depth(
        self,
        first: Float[np.ndarray, "2"],
        second: Float[np.ndarray, "2"],
        length_m: float,
    ) -> float:
        """The nominal distance at which a pinhole camera has this scale."""
        return self.camera.focal_length_px / self.scale

    def reach(
        self, known: Float[np.ndarray, "... 3"], pixel: Float[np.ndarray, "2"], length_m: float
    ) -> LimbEnds:
        """Taylor's relative depth, with either sign."""
        plane = self._plane(pixel)
        seen = np.linalg.norm(known[..., :2] - plane, axis=-1)
        half = np.sqrt(np.maximum(length_m**2 - seen**2, 0.0))
        depth = np.stack([known[..., 2] - half, known[..., 2] + half], axis=-1)
        return LimbEnds(
            points=self.place(pixel, depth),
            overreach_m=np.asarray(np.maximum(seen - length_m, 0.0)),
        )

    def spread(
        self,
        middle_depth: Float[np.ndarray, "..."],
        first: Float[np.ndarray, "2"],
        second: Float[np.ndarray, "2"],
        width_m: float,
    ) -> CrossPieceEnds:
        """Half of the relative depth on either side of the middle."""
        middle_depth = np.asarray(middle_depth, dtype=np.float64)
        seen = float(np.linalg.norm(self._plane(first) - self._plane(second)))
        half = 0.5 * np.sqrt(max(width_m**2 - seen**2, 0.0))
        second_depth = np.stack([middle_depth - half, middle_depth + half], axis=-1)
        return CrossPieceEnds(
            first=self.place(first, 2.0 * middle_depth[..., None] - second_depth),
            second=self.place(second, second_depth),
            overreach_m=np.full_like(middle_depth, max(seen - width_m, 0.0)),
        )

    def _plane(self, pixel: Float[np.ndarray, "2"]) -> Float[np.ndarray, "2"]:
        return (pixel - [self.camera.centre_x, self.camera.centre_y]) / self.scale
