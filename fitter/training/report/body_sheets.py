"""Sheets of bodies at one scale, standing on one floor line: to be looked at, and compared.

Seen from so far away that the picture is parallel to a thousandth: heights can be read off lines.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import UInt8

from fitter.arrays import Triangles, Vertices
from fitter.body.scape import CAMERA_AXES
from fitter.export.display import block_means, finer, to_levels
from fitter.export.views import turned_about_vertical
from fitter.observation.colour import display_from_linear
from fitter.render.camera import Camera
from fitter.render.interpolation import shade_image
from fitter.render.rasterizer import render

FRONT, THREE_QUARTER, SIDE = 0.0, 40.0, 90.0
"""Degrees an onlooker walks to the right round the body."""

DISTANCE_M = 200.0
SUPERSAMPLING = 3
HEADROOM_M = 0.05
FLOOR_M = 0.10
SIDE_ROOM_M = 0.04

TO_LIGHT = np.array([-0.55, -0.52, -0.65])
FILL_LIGHT = 0.14
CLAY = np.array([0.62, 0.53, 0.47])
PAPER = 1.0

LINE_COLOUR = (170, 190, 215)
TEXT_COLOUR = (60, 60, 60)
TITLE_PX = 26
FONT = cv2.FONT_HERSHEY_SIMPLEX

Levels = UInt8[np.ndarray, "h w 3"]


@dataclass(frozen=True, slots=True, kw_only=True)
class SheetScale:
    """Size of every panel of a sheet, and how much of the world it shows."""

    width_px: int
    height_px: int
    px_per_m: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Panel:
    """One body from one side.

    Attributes
    ----------
    vertices
        (m, 3) body frame, metres.
    degrees
        Direction it is seen from: :data:`FRONT`, :data:`THREE_QUARTER`, :data:`SIDE`.
    label
        Written under it.
    lines_m
        Heights above the soles at which lines run behind it.
    """

    vertices: Vertices
    degrees: float
    label: str
    lines_m: tuple[float, ...]


def scale_for(bodies: Sequence[Vertices], *, px_per_m: float) -> SheetScale:
    """Panels that hold every one of the bodies, seen from any side."""
    tallest = max(float(np.ptp(body[:, 1])) for body in bodies)
    widest = max(float(2.0 * np.abs(body[:, [0, 2]]).max()) for body in bodies)
    return SheetScale(
        width_px=round(px_per_m * (widest + SIDE_ROOM_M)),
        height_px=round(px_per_m * (tallest + HEADROOM_M + FLOOR_M)),
        px_per_m=px_per_m,
    )


def sheet(
    groups: Mapping[str, Sequence[Panel]],
    triangles: Triangles,
    scale: SheetScale,
    *,
    groups_per_row: int,
) -> Levels:
    """Titled groups of panels, row by row; white where the last row has none."""
    titled = [
        _titled(title, np.concatenate([_drawn(p, triangles, scale) for p in panels], axis=1))
        for title, panels in groups.items()
    ]
    widest = max(group.shape[1] for group in titled)
    padded = [
        np.pad(g, ((0, 0), (0, widest - g.shape[1] + 8), (0, 0)), constant_values=255)
        for g in titled
    ]
    blank = np.full_like(padded[0], 255)
    missing = -len(padded) % groups_per_row
    padded += [blank] * missing
    rows = [
        np.concatenate(padded[start : start + groups_per_row], axis=1)
        for start in range(0, len(padded), groups_per_row)
    ]
    return np.concatenate(rows)


def _drawn(panel: Panel, triangles: Triangles, scale: SheetScale) -> Levels:
    floor = float(panel.vertices[:, 1].min())
    middle = np.array([0.0, floor, 0.0])
    seen = (panel.vertices - middle) * CAMERA_AXES
    seen = turned_about_vertical(seen, np.zeros(3), panel.degrees) + [0.0, 0.0, DISTANCE_M]
    camera = Camera(
        focal_length_px=scale.px_per_m * DISTANCE_M,
        centre_x=0.5 * scale.width_px,
        centre_y=scale.height_px - FLOOR_M * scale.px_per_m,
        width=scale.width_px,
        height=scale.height_px,
    )
    rendering = render(seen, triangles, finer(camera, SUPERSAMPLING))
    lit = np.clip(rendering.vertex_normals @ TO_LIGHT, 0.0, 1.0)
    grey = block_means(shade_image(rendering, FILL_LIGHT + (1.0 - FILL_LIGHT) * lit), SUPERSAMPLING)
    coverage = block_means(rendering.silhouette.astype(np.float32), SUPERSAMPLING)[..., None]
    body = to_levels(display_from_linear(grey[..., None] * CLAY + PAPER * (1.0 - coverage)))
    paper = np.full_like(body, 255)
    for height_m in (0.0, *panel.lines_m):
        row = round(camera.centre_y - height_m * scale.px_per_m)
        cv2.line(paper, (0, row), (scale.width_px, row), LINE_COLOUR, 1)
    # Where nothing of the body covers a pixel its line shows, elsewhere the body.
    picture = np.where(coverage > 0.0, body, paper)
    _write(picture, panel.label, row_px=scale.height_px - 5, size=0.4)
    return picture


def _titled(title: str, picture: Levels) -> UInt8[np.ndarray, "titled_h w 3"]:
    band = np.full((TITLE_PX, picture.shape[1], 3), 255, dtype=np.uint8)
    _write(band, title, row_px=TITLE_PX - 8, size=0.5)
    return np.concatenate([band, picture])


def _write(picture: Levels, text: str, *, row_px: int, size: float) -> None:
    cv2.putText(picture, text, (6, row_px), FONT, size, TEXT_COLOUR, 1, cv2.LINE_AA)
