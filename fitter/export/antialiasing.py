"""Anti-aliased pictures of colours on a body: several samples to a pixel, averaged in linear light.

Drawn where the body is and in one pass, from the vertices' colours to the levels of a file.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, UInt8

from fitter.arrays import PerVertex, Triangles, Vertices
from fitter.export import _antialiasing_kernels as kernels
from fitter.export._antialiasing_kernels import SAMPLES
from fitter.export.display import (
    FIRST_LEVELS,
    LEVEL_STEPS,
    finer,
    levels_of_linear,
    slope_bounds,
)
from fitter.render.camera import Camera
from fitter.render.rasterizer import NEAR_PLANE_M, Rendering, render

PAPER = 1.0
"""Linear value around the body: white."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FineRendering:
    """A mesh rendered with :data:`SAMPLES` x :data:`SAMPLES` samples a pixel, where it lies.

    Attributes
    ----------
    camera
        Of the whole picture.
    left, top
        The pixel in which the part that was rendered begins.
    rendering
        Of that part, by a camera :data:`SAMPLES` times as fine.
    """

    camera: Camera
    left: int
    top: int
    rendering: Rendering


def render_finely(vertices: Vertices, triangles: Triangles, camera: Camera) -> FineRendering:
    """Render a closed mesh, given in the camera frame, for pictures by this camera."""
    left, top, right, bottom = _extent(vertices, camera)
    window = Camera(
        focal_length_px=camera.focal_length_px,
        centre_x=camera.centre_x - left,
        centre_y=camera.centre_y - top,
        width=right - left,
        height=bottom - top,
    )
    return FineRendering(
        camera=camera,
        left=left,
        top=top,
        rendering=render(vertices, triangles, finer(window, SAMPLES)),
    )


def vertex_pictures(
    linear_values: Sequence[Float[np.ndarray, "m 3"] | PerVertex], fine: FineRendering
) -> UInt8[np.ndarray, "k h w 3"]:
    """A picture before white paper of each of k fields on the vertices, sRGB-coded.

    Parameters
    ----------
    linear_values
        Grey or red, green and blue; clipped to [0, 1] where they are seen.
    fine
        Of the body.
    """
    columns = [each.reshape(len(each), -1) for each in linear_values]
    starts = np.cumsum([0, *(each.shape[1] for each in columns)])
    channels = [
        start + np.arange(3) % each.shape[1] for start, each in zip(starts, columns, strict=False)
    ]
    camera, rendering = fine.camera, fine.rendering
    paper = levels_of_linear(np.array([PAPER]))[0]
    pictures = np.full((len(columns), camera.height, camera.width, 3), paper, dtype=np.uint8)
    planes = kernels.value_planes(
        rendering.triangles,
        rendering.front_facing,
        rendering.projected,
        # A triangle with a corner before the near plane is not drawn.
        1.0 / np.maximum(rendering.vertices[:, 2], NEAR_PLANE_M),
        np.ascontiguousarray(np.concatenate(columns, axis=1), dtype=np.float64),
    )
    kernels.draw_levels(
        rendering.face_ids,
        planes,
        PAPER,
        np.array(channels),
        FIRST_LEVELS,
        LEVEL_STEPS,
        fine.left,
        fine.top,
        pictures,
    )
    return pictures


def _extent(vertices: Vertices, camera: Camera) -> tuple[int, int, int, int]:
    """First and end column and row of the pixels that may show the mesh, at least one."""
    if vertices[:, 2].min() <= NEAR_PLANE_M:
        return 0, 0, camera.width, camera.height
    least, greatest = slope_bounds(vertices)
    middle = np.array([camera.centre_x, camera.centre_y])
    size = np.array([camera.width, camera.height])
    first = np.floor(middle + camera.focal_length_px * least)
    end = np.ceil(middle + camera.focal_length_px * greatest)
    low = np.clip(first, 0, size - 1).astype(int)
    high = np.clip(end, low + 1, size).astype(int)
    return (*low.tolist(), *high.tolist())
