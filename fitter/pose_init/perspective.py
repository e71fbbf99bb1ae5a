"""Limbs in perspective: H.-J. Lee and Z. Chen, CVGIP 30(2), 1985 (the paper's [15]).

The far end of a limb lies on the ray of its click and on a sphere around its near end, with the
limb's length as radius: two solutions, or none if the limb appears longer than it can be. In that
case the point of the ray nearest to the sphere is taken (the limb is as parallel to the image as
possible) and the excess is reported.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.pose_init.lifting import CrossPieceEnds, LimbEnds
from fitter.render.camera import Camera


@dataclass(frozen=True, slots=True, kw_only=True)
class PerspectiveLifting:
    """Lee and Chen's construction for a pinhole camera."""

    camera: Camera

    def place(
        self, pixel: Float[np.ndarray, "2"], depth: Float[np.ndarray, "..."]
    ) -> Float[np.ndarray, "... 3"]:
        """The point of the pixel's ray at this depth."""
        return np.asarray(depth)[..., None] * self.camera.rays(pixel)

    def parallel_depth(
        self, first: Float[np.ndarray, "2"], second: Float[np.ndarray, "2"], length_m: float
    ) -> float:
        """Similar triangles: depth / focal length = length / image length."""
        return self.camera.focal_length_px * length_m / float(np.linalg.norm(first - second))

    def reach(
        self, known: Float[np.ndarray, "... 3"], pixel: Float[np.ndarray, "2"], length_m: float
    ) -> LimbEnds:
        """Solve ‖t u - P‖ = L: t = u·P ± sqrt((u·P)² - ‖P‖² + L²), u the unit ray."""
        ray = self.camera.rays(pixel)
        ray = ray / np.linalg.norm(ray)
        along = known @ ray
        missed = np.linalg.norm(known - along[..., None] * ray, axis=-1)
        half = np.sqrt(np.maximum(length_m**2 - missed**2, 0.0))
        distances = np.stack([along - half, along + half], axis=-1)
        return LimbEnds(
            points=distances[..., None] * ray,
            overreach_m=np.asarray(np.maximum(missed - length_m, 0.0)),
        )

    def spread(
        self,
        middle_depth: Float[np.ndarray, "..."],
        first: Float[np.ndarray, "2"],
        second: Float[np.ndarray, "2"],
        width_m: float,
    ) -> CrossPieceEnds:
        """Solve ‖(z - e) q - (z + e) p‖ = width for e, with rays p, q of unit depth.

        The ends lie at depths z + e (first) and z - e (second), so that the middle is at z.
        """
        first_ray, second_ray = self.camera.rays(first), self.camera.rays(second)
        difference, total = second_ray - first_ray, second_ray + first_ray
        middle_depth = np.asarray(middle_depth, dtype=np.float64)
        square = float(total @ total)
        centre = middle_depth * float(difference @ total) / square
        shortest = np.linalg.norm(
            middle_depth[..., None] * difference - centre[..., None] * total, axis=-1
        )
        half = np.sqrt(np.maximum(width_m**2 - shortest**2, 0.0) / square)
        offset = np.stack([centre + half, centre - half], axis=-1)
        return CrossPieceEnds(
            first=(middle_depth[..., None] + offset)[..., None] * first_ray,
            second=(middle_depth[..., None] - offset)[..., None] * second_ray,
            overreach_m=np.asarray(np.maximum(shortest - width_m, 0.0)),
        )
