"""What a picture shows of points on a fitted body's surface, and how far that can be believed."""

from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import GreyImage, Image, Mask, Points2D, Triangles, Vertices
from fitter.evidence.sampling import sample
from fitter.numerics.vectors import unit_vectors
from fitter.render.camera import Camera
from fitter.render.rasterizer import DEPTH_TOLERANCE_M, Rendering, render

GRAZING, SQUARE = 0.2, 0.5
"""Cosines between normal and view: below the first a surface is not read from a picture, from the
second on it is believed wholly. In between a pixel spans more and more of the surface."""

CONTOUR_M = 0.008
"""A fitted contour lies so far off the person's: nearer to one, a pixel may show what is behind."""

DEPTH_JUMP_M = 0.05
"""A jump of depth within that distance is a contour, on the outline or before the body itself. A
surface turned 75 degrees away sinks 3 cm there."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SurfacePoints:
    """k points on triangles of the body.

    Attributes
    ----------
    corners
        (k, 3) vertex ids.
    weights
        (k, 3) barycentric coordinates.
    """

    corners: Integer[np.ndarray, "k 3"]
    weights: Float[np.ndarray, "k 3"]

    def of(self, values: Float[np.ndarray, "m ..."]) -> Float[np.ndarray, "k ..."]:
        """Values of vertices, interpolated."""
        weights = self.weights.reshape(*self.weights.shape, *(1,) * (values.ndim - 1))
        return (values[self.corners] * weights).sum(axis=1)


@dataclass(frozen=True, eq=False, kw_only=True)
class SeenSurface:
    """A posed body before its picture.

    Attributes
    ----------
    rendering
        The body, camera frame, at the picture's size.
    linear_rgb
        (h, w, 3) the picture in linear light.
    clear
        (h, w) 1 where a pixel shows the body's own surface, off every contour.
    """

    rendering: Rendering
    linear_rgb: Image
    clear: GreyImage

    @classmethod
    def of(
        cls,
        vertices: Vertices,
        triangles: Triangles,
        camera: Camera,
        linear_rgb: Image,
        mask: Mask | None,
    ) -> "SeenSurface":
        """Put a body before its picture.

        Parameters
        ----------
        vertices
            (m, 3) camera frame, metres.
        camera
            Of this picture, whose size it has.
        mask
            (h, w) the person, where that is known better than by the body's own outline.
        """
        rendering = render(vertices, triangles, camera)
        return cls(rendering=rendering, linear_rgb=linear_rgb, clear=_off_contours(rendering, mask))

    @cached_property
    def _channels(self) -> tuple[GreyImage, ...]:
        return tuple(np.ascontiguousarray(self.linear_rgb[..., k]) for k in range(3))

    def colours(self, points: SurfacePoints) -> Float[np.ndarray, "k 3"]:
        """Linear red, green and blue where the points are in the picture, seen or not."""
        pixels = self._pixels(points)
        return np.stack([sample(channel, pixels)[0] for channel in self._channels], axis=1)

    def belief(self, points: SurfacePoints) -> Float[np.ndarray, " k"]:
        """How far the picture shows a point: 0 for hidden, 1 for seen squarely."""
        positions = points.of(self.rendering.vertices)
        normals = unit_vectors(points.of(self.rendering.vertex_normals))
        pixels = self._pixels(points)
        height, width = self.clear.shape
        x, y = pixels.T
        inside = (x >= 0.0) & (x < width) & (y >= 0.0) & (y < height)
        columns, rows = (np.where(inside, each, 0.0).astype(np.intp) for each in (x, y))
        depth = self.rendering.depth[rows, columns]
        far = positions[:, 2]
        seen = inside & (far > 0.0) & (far < depth + DEPTH_TOLERANCE_M)
        cosines = -(normals * unit_vectors(positions)).sum(axis=1)
        squarely = smooth_step(cosines, GRAZING, SQUARE)
        return np.where(seen, squarely, 0.0) * self.clear[rows, columns]

    def _pixels(self, points: SurfacePoints) -> Points2D:
        return self.rendering.camera.project(points.of(self.rendering.vertices))


def smooth_step(
    values: Float[np.ndarray, " k"], low: float, high: float
) -> Float[np.ndarray, " k"]:
    """0 up to ``low``, 1 from ``high`` on, and without a corner from one to the other."""
    share = np.clip((values - low) / (high - low), 0.0, 1.0)
    return share * share * (3.0 - 2.0 * share)


def _off_contours(rendering: Rendering, mask: Mask | None) -> GreyImage:
    """Blurred by the same width, so that what is believed fades out before a contour."""
    depth = rendering.depth.astype(np.float32)
    shown = np.isfinite(depth) if mask is None else np.isfinite(depth) & mask
    if not shown.any():
        return np.zeros(depth.shape, dtype=np.float32)
    far = np.float32(depth[shown].max() + 1.0)
    depth = np.where(shown, depth, far)
    metre_px = rendering.camera.focal_length_px / float(np.median(depth[shown]))
    width = 2 * max(round(CONTOUR_M * metre_px), 1) + 1
    window = np.ones((width, width), dtype=np.uint8)
    jump = cv2.dilate(depth, window) - cv2.erode(depth, window)
    clear = (shown & (jump < DEPTH_JUMP_M)).astype(np.float32)
    return cv2.GaussianBlur(clear, (width, width), 0.0) * clear
