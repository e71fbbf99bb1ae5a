"""Camera models that lift clicked limbs into three dimensions.

There are two: :mod:`fitter.pose_init.lifting` (Lee and Chen, the paper's choice) and
:mod:`fitter.pose_init.lifting` (Taylor, the paper's comparison). The code that traverses the
body (:mod:`fitter.pose_init.trunk`, :mod:`fitter.pose_init.initial_pose`) knows only this protocol.

The far end of a limb lies on the ray of its click and on a sphere around its near end, with the
limb's length as radius: two solutions, or none if the limb appears longer than it can be. In that
case the point of the ray nearest to the sphere is taken (the limb is as parallel to the image as
possible) and the excess is reported.

A metre anywhere on the body spans ``scale`` pixels, and a limb's relative depth follows from its
foreshortening: (z₁ - z₂)² = L² - (Δu² + Δv²) / scale². Kept for the comparison the paper makes
(Fig. 2b): it has no absolute depth, and bends limbs that perspective enlarges or shrinks.
The result is placed at focal length / scale so that both methods give the same kind of result.
"""

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from fitter.render.camera import Camera

NEAR, FAR = 0, 1
"""The two solutions for the far end of a limb: nearer to the camera, or farther."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LimbEnds:
    """Both possible positions of the other end of a limb.

    Attributes
    ----------
    points
        (..., 2, 3) camera frame, metres; the nearer one first.
    overreach_m
        (...) how much too long the limb appears: distance from the known end to the returned
        point minus the limb's length, if no point of the ray is within reach; else 0.
    """

    points: Float[np.ndarray, "... 2 3"]
    overreach_m: Float[np.ndarray, "..."]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CrossPieceEnds:
    """Both ways a rigid width can lie when the depth of its middle is known.

    Attributes
    ----------
    first, second
        (..., 2, 3) camera frame, metres; the solution with the second end nearer comes first.
    overreach_m
        As for :class:`LimbEnds`.
    """

    first: Float[np.ndarray, "... 2 3"]
    second: Float[np.ndarray, "... 2 3"]
    overreach_m: Float[np.ndarray, "..."]


@runtime_checkable
class Lifting(Protocol):
    """A camera model's three constructions; pixels are (2,), lengths metres."""

    def place(
        self, pixel: Float[np.ndarray, "2"], depth: Float[np.ndarray, "..."]
    ) -> Float[np.ndarray, "... 3"]:
        """The point of the pixel's ray at this depth (camera-frame z)."""
        ...

    def parallel_depth(
        self, first: Float[np.ndarray, "2"], second: Float[np.ndarray, "2"], length_m: float
    ) -> float:
        """Depth at which a limb of this length, parallel to the image, spans the two pixels."""
        ...

    def reach(
        self, known: Float[np.ndarray, "... 3"], pixel: Float[np.ndarray, "2"], length_m: float
    ) -> LimbEnds:
        """The points of the pixel's ray at the limb's length from its known end."""
        ...

    def spread(
        self,
        middle_depth: Float[np.ndarray, "..."],
        first: Float[np.ndarray, "2"],
        second: Float[np.ndarray, "2"],
        width_m: float,
    ) -> CrossPieceEnds:
        """The ends of a rigid width on two rays, its middle at this depth."""
        ...


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
