"""What the fit saw and found, as pictures on the original's pixels, at most 1600 on a side."""

import cv2
import numpy as np
from jaxtyping import Float, UInt8

from fitter.arrays import Mask, PerVertex, Triangles, Vertices
from fitter.export.display import block_means, to_levels
from fitter.numerics.mesh_topology import mesh_topology
from fitter.observation.colour import display_from_linear
from fitter.observation.resampling import WorkingSize, linear_working_picture
from fitter.render.camera import Camera
from fitter.render.contours import model_edges
from fitter.render.interpolation import shade_image
from fitter.render.rasterizer import Rendering, render
from fitter.segmentation.trimap import Trimap, trimap_picture

LONGEST_SIDE_PX = 1600

SUPERSAMPLING = 2
"""Rendered pictures are drawn at twice the size and averaged, in linear light."""

SURROUNDINGS = 1.0
"""Linear value around the body in rendered pictures: white paper."""

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


def drawing_picture(
    pixels: Levels, image_camera: Camera, camera: Camera
) -> UInt8[np.ndarray, "{camera.height} {camera.width} 3"]:
    """The original on the drawing camera's pixels, averaged in linear light."""
    if pixels.shape[:2] == (camera.height, camera.width):
        return pixels
    factor = camera.focal_length_px / image_camera.focal_length_px
    size = WorkingSize(width=camera.width, height=camera.height, scale=factor)
    return to_levels(display_from_linear(linear_working_picture(pixels, size)))


def mask_levels(mask: Mask, working: Camera, camera: Camera) -> CameraLevels:
    """255 inside, 0 outside, from the working picture's pixels to the drawing camera's."""
    return _enlarged(np.where(mask, 255, 0).astype(np.uint8), working, camera)


def trimap_levels(labels: Trimap, working: Camera, camera: Camera) -> CameraLevels:
    """Body 255, background 0, unknown 128, on the drawing camera's pixels (Fig. 3b)."""
    return _enlarged(to_levels(trimap_picture(labels)[..., 0]), working, camera)


def overlay_picture(
    picture: Levels, vertices: Vertices, triangles: Triangles, camera: Camera
) -> Levels:
    """The body's outline (green) and inner occluding edges (amber) over the picture.

    Parameters
    ----------
    picture
        (h, w, 3) on the camera's pixels.
    vertices
        (m, 3) camera frame, metres.
    """
    rendering = render(vertices, triangles, camera)
    edges = model_edges(rendering, mesh_topology(triangles, vertex_count=len(vertices)))
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


def vertex_value_picture(
    linear_values: Float[np.ndarray, "m 3"] | PerVertex, rendering: Rendering
) -> Levels:
    """Linear values on vertices, grey or red-green-blue, as a rendering shows them.

    Parameters
    ----------
    linear_values
        Clipped to [0, 1] where they are seen, then sRGB-coded.
    rendering
        By a camera ``SUPERSAMPLING`` times as fine as the picture.
    """
    columns = [linear_values] if linear_values.ndim == 1 else list(linear_values.T)
    seen = [shade_image(rendering, column, background=SURROUNDINGS) for column in columns]
    channels = [block_means(np.clip(channel, 0.0, 1.0), SUPERSAMPLING) for channel in seen]
    levels = [to_levels(display_from_linear(channel)) for channel in channels]
    return np.stack(levels * (3 // len(levels)), axis=2)


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
    return levels[rows[:, None], columns]


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
    for start, end in scaled.tolist():
        cv2.line(canvas, start, end, levels, thickness, cv2.LINE_AA, _SUBPIXEL_BITS)
