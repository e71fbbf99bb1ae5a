"""Pictures of what the fit saw and found, on the original's pixels, at most 1600 on a side."""

from typing import cast

import cv2
import numpy as np
from jaxtyping import Float, UInt8

from fitter.arrays import Mask, Triangles, Vertices
from fitter.export.display import levels_of_linear, to_levels
from fitter.numerics.meshes import MeshTopology
from fitter.observation.pixels import WorkingSize, linear_working_picture
from fitter.render.camera import Camera
from fitter.render.contours import model_edges
from fitter.render.rasterizer import render
from fitter.segmentation.trimap import Trimap, trimap_picture

LONGEST_SIDE_PX = 1600

OUTER_COLOUR = (0.10, 1.00, 0.25)
INNER_COLOUR = (1.00, 0.75, 0.05)
HALO_COLOUR = (0.0, 0.0, 0.0)
"""Display red, green and blue: the silhouette, the edges inside it, and a dark rim that keeps both
legible on any picture."""

LINE_SHARE = 1 / 900
"""Width of the inner lines, as a share of the picture's longer side."""

_SUBPIXEL_BITS = 4
_FARTHEST_PX = 1e5
"""Beyond this OpenCV's fixed-point coordinates could overflow."""

Levels = UInt8[np.ndarray, "h w 3"]
CameraLevels = UInt8[np.ndarray, "{camera.height} {camera.width}"]
"""On the pixels of the argument ``camera``."""


def drawing_camera(image_camera: Camera) -> Camera:
    """The original picture's camera, made coarser where a side exceeds the limit."""
    factor = min(1.0, LONGEST_SIDE_PX / max(image_camera.width, image_camera.height))
    return image_camera.scaled(
        factor,
        width=max(1, int(image_camera.width * factor)),
        height=max(1, int(image_camera.height * factor)),
    )


def drawing_pixels(image_camera: Camera) -> float:
    """Number of the original's pixels that the drawing camera's picture can be made from."""
    factor = drawing_camera(image_camera).focal_length_px / image_camera.focal_length_px
    return factor**2 * image_camera.width * image_camera.height


def drawing_picture(
    pixels: Levels, image_camera: Camera, camera: Camera, *, reduction: int = 1
) -> UInt8[np.ndarray, "{camera.height} {camera.width} 3"]:
    """The original on the drawing camera's pixels, averaged in linear light.

    Parameters
    ----------
    pixels
        The original, or what is left of it where it was decoded at a part of its size.
    reduction
        How much smaller it was decoded.
    """
    if pixels.shape[:2] == (camera.height, camera.width):
        return pixels
    factor = camera.focal_length_px / image_camera.focal_length_px
    size = WorkingSize(width=camera.width, height=camera.height, scale=factor)
    return levels_of_linear(linear_working_picture(pixels, size.from_reduced(reduction)))


def mask_levels(mask: Mask, working: Camera, camera: Camera) -> CameraLevels:
    """255 inside, 0 outside, from the working picture's pixels to the drawing camera's."""
    return _enlarged(np.where(mask, 255, 0).astype(np.uint8), working, camera)


def trimap_levels(labels: Trimap, working: Camera, camera: Camera) -> CameraLevels:
    """Body 255, background 0, unknown 128, on the drawing camera's pixels (Fig. 3b)."""
    every_label = np.arange(1 + labels.max(), dtype=labels.dtype)[None]
    level_of_label = to_levels(trimap_picture(every_label)[0, :, 0])
    return _enlarged(level_of_label[labels], working, camera)


def overlay_picture(
    picture: Levels,
    vertices: Vertices,
    triangles: Triangles,
    topology: MeshTopology,
    camera: Camera,
) -> Levels:
    """The body's outline (green) and inner occluding edges (amber) over the picture.

    Parameters
    ----------
    picture
        (h, w, 3) on the camera's pixels.
    vertices
        (m, 3) camera frame, metres.
    topology
        Of the triangles.
    """
    edges = model_edges(render(vertices, triangles, camera), topology)
    outer = edges.endpoints[edges.visible & edges.is_outer_silhouette]
    inner = edges.endpoints[edges.visible & ~edges.is_outer_silhouette]
    width = max(1, round(LINE_SHARE * max(camera.width, camera.height)))
    canvas = picture.copy()
    for segments, colour, thickness in (
        (inner, HALO_COLOUR, width + 2),
        (outer, HALO_COLOUR, width + 2),
        (inner, INNER_COLOUR, width),
        (outer, OUTER_COLOUR, width),
    ):
        _draw(canvas, segments, colour, thickness)
    return canvas


def _enlarged(levels: UInt8[np.ndarray, "a b"], working: Camera, camera: Camera) -> CameraLevels:
    """The working pixel under the centre of each drawing pixel.

    By the cameras' scales, not by the pictures' sizes: the working picture leaves out the fraction
    of a pixel at the border.
    """
    ratio = working.focal_length_px / camera.focal_length_px
    rows = ((np.arange(camera.height) + 0.5) * ratio).astype(int)
    columns = ((np.arange(camera.width) + 0.5) * ratio).astype(int)
    rows = np.minimum(rows, levels.shape[0] - 1)
    columns = np.minimum(columns, levels.shape[1] - 1)
    # Columns first, while there are few rows: both at once take eight times as long.
    return levels.take(columns, axis=1).take(rows, axis=0)


def _draw(
    canvas: Levels,
    segments: Float[np.ndarray, "k 2 2"],
    colour: tuple[float, float, float],
    thickness: int,
) -> None:
    # OpenCV's pixel centres are whole numbers, ours lie at one half.
    near = (np.abs(segments) < _FARTHEST_PX).all(axis=(1, 2))
    scaled = np.rint((segments[near] - 0.5) * 2**_SUBPIXEL_BITS).astype(np.int32)
    levels = [int(level) for level in to_levels(np.array(colour))]
    lines = cast("list[np.ndarray]", scaled)  # As good to OpenCV, and nothing to build.
    cv2.polylines(canvas, lines, False, levels, thickness, cv2.LINE_AA, _SUBPIXEL_BITS)
