"""Where the tapes of a body lie, seen from its front, its right side and its back: lines to draw.

Lines are cut to what the body does not hide, and come in pixels of a pale picture of the body.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from jaxtyping import Bool, Float, UInt8

from fitter.arrays import Points2D, Points3D, Triangles, Vertices
from fitter.body.scape import CAMERA_AXES
from fitter.export.display import slope_bounds, to_levels
from fitter.export.views import CANONICAL_DISTANCE_M, clay_picture, turned_about_vertical
from fitter.render.camera import Camera
from fitter.render.rasterizer import Rendering, render

SIDES_DEGREES = {"front": 0.0, "side": -90.0, "back": 180.0}
"""How far an onlooker has walked to the right round the body: its right side is at their left."""

PX_PER_M = 640.0
MARGIN_M = 0.04
STEP_M = 0.004
HIDDEN_M = 0.012
"""A point of a tape this far behind the skin is hidden: a taut tape touches it or lies outside."""

PREFERENCE = 1.5
"""A tape is seen from a later side only if that shows so much more of it than an earlier one."""

PALE = 0.55
"""How far the body is blended with white, for lines to stand out."""

Polyline = Float[np.ndarray, "_ 2"]
"""Pixels."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TapeView:
    """The body from one side.

    Attributes
    ----------
    side
        A key of :data:`SIDES_DEGREES`.
    picture
        The body, pale.
    lines
        Polylines of what is seen of each tape, by the measurement's name, pixels.
    """

    side: str
    picture: UInt8[np.ndarray, "h w 3"]
    lines: Mapping[str, tuple[Polyline, ...]]

    def shown_length(self, name: str) -> float:
        """Of a tape as it appears, pixels: what is foreshortened tells less."""
        return float(sum(_length(line) for line in self.lines[name]))


def tape_views(
    vertices: Vertices,
    triangles: Triangles,
    lines: Mapping[str, Points3D],
    *,
    straight: Collection[str],
) -> tuple[TapeView, ...]:
    """Draw the body from every side, and find what is seen of each tape there.

    Parameters
    ----------
    vertices, triangles
        The body in the body frame, metres.
    lines
        Tapes by the measurements' names, in the same frame.
    straight
        Names of those that run straight through the body: nothing hides them.
    """
    dense = {name: _dense(line) for name, line in lines.items()}
    return tuple(
        _view(side, degrees, vertices, triangles, dense, straight)
        for side, degrees in SIDES_DEGREES.items()
    )


def best_sides(views: Sequence[TapeView]) -> Mapping[str, str]:
    """The side each tape is seen from best, by its name."""
    return {name: _best(name, views).side for name in views[0].lines}


def _best(name: str, views: Sequence[TapeView]) -> TapeView:
    best = views[0]
    for view in views[1:]:
        if view.shown_length(name) > PREFERENCE * best.shown_length(name):
            best = view
    return best


def _view(
    side: str,
    degrees: float,
    vertices: Vertices,
    triangles: Triangles,
    lines: Mapping[str, Points3D],
    straight: Collection[str],
) -> TapeView:
    middle = 0.5 * (vertices.max(axis=0) + vertices.min(axis=0))
    body = _seen(vertices, middle, degrees)
    camera = _camera(body)
    rendering = render(body, triangles, camera)
    clay = clay_picture(body, triangles, camera).astype(np.float64) / 255.0
    return TapeView(
        side=side,
        picture=to_levels(PALE + (1.0 - PALE) * clay),
        lines={
            name: _shown(_seen(line, middle, degrees), rendering, hides=name not in straight)
            for name, line in lines.items()
        },
    )


def _seen(points: Points3D, middle: Float[np.ndarray, "3"], degrees: float) -> Points3D:
    turned = turned_about_vertical((points - middle) * CAMERA_AXES, np.zeros(3), degrees)
    return turned + [0.0, 0.0, CANONICAL_DISTANCE_M]


def _camera(body: Vertices) -> Camera:
    """A picture as large as the body and its margins; all sides have one scale."""
    focal = PX_PER_M * CANONICAL_DISTANCE_M
    low, high = (focal * bound for bound in slope_bounds(body))
    margin = MARGIN_M * PX_PER_M
    width, height = np.ceil(high - low + 2.0 * margin).astype(int).tolist()
    return Camera(
        focal_length_px=focal,
        centre_x=float(margin - low[0]),
        centre_y=float(margin - low[1]),
        width=width,
        height=height,
    )


def _dense(line: Points3D) -> Float[np.ndarray, "d 3"]:
    """Points every few millimetres along a line."""
    pieces = [
        np.linspace(start, end, max(2, int(np.linalg.norm(end - start) / STEP_M)))[:-1]
        for start, end in pairwise(line)
    ]
    return np.concatenate([*pieces, line[-1:]])


def _shown(points: Points3D, rendering: Rendering, *, hides: bool) -> tuple[Polyline, ...]:
    """The runs of a line's points that nothing hides, projected."""
    camera = rendering.camera
    flat = camera.focal_length_px * points[:, :2] / points[:, 2:]
    pixels = flat + [camera.centre_x, camera.centre_y]
    if not hides:
        return (pixels[[0, -1]],) if len(pixels) == 2 else (pixels,)
    visible = _visible(pixels, points[:, 2], rendering)
    ends = np.flatnonzero(np.diff(np.concatenate([[False], visible, [False]]).astype(np.int8)))
    return tuple(
        pixels[start:end] for start, end in ends.reshape(-1, 2).tolist() if end - start > 1
    )


def _visible(
    pixels: Points2D, depth: Float[np.ndarray, " k"], rendering: Rendering
) -> Bool[np.ndarray, " k"]:
    height, width = rendering.face_ids.shape
    columns, rows = np.floor(pixels).astype(int).T
    inverse = rendering.inverse_depth[rows.clip(0, height - 1), columns.clip(0, width - 1)]
    return (inverse == 0.0) | (depth * inverse < 1.0 + HIDDEN_M * inverse)


def _length(line: Polyline) -> float:
    return float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())
