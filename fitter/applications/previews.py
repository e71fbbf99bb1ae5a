"""Bodies side by side as plain clay, in one scale, for people looking at what was made of a fit."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import UInt8

from fitter.arrays import Triangles, Vertices
from fitter.body.scape import CAMERA_AXES
from fitter.export.views import (
    CANONICAL_DISTANCE_M,
    PANEL_HEIGHT_PX,
    PANEL_WIDTH_PX,
    clay_panel,
    framing_camera,
    turned_about_vertical,
)

EYE_LEVEL_M = 0.9
"""Height of the onlooker's eye above the ground: about the middle of a standing body."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class View:
    """A body as it is to be seen.

    Attributes
    ----------
    label
        Written above it.
    vertices
        (m, 3) body frame, metres; it stands on its lowest vertex.
    degrees
        How far the onlooker has walked to the right round it, from its front.
    """

    label: str
    vertices: Vertices
    degrees: float = 0.0


def preview(views: Sequence[View], triangles: Triangles) -> UInt8[np.ndarray, "h w 3"]:
    """Panels from left to right, in one scale and on one ground."""
    seen = [_seen(view) for view in views]
    camera = framing_camera(np.concatenate(seen), width=PANEL_WIDTH_PX, height=PANEL_HEIGHT_PX)
    return np.concatenate(
        [
            clay_panel(vertices, triangles, view.label, camera)
            for view, vertices in zip(views, seen, strict=True)
        ],
        axis=1,
    )


def _seen(view: View) -> Vertices:
    """Vertices in the frame of a camera at half the body's height or so."""
    there = np.array([0.0, 0.0, CANONICAL_DISTANCE_M])
    low, high = view.vertices.min(axis=0), view.vertices.max(axis=0)
    middle = 0.5 * (low + high)
    grounded = view.vertices - [middle[0], low[1] + EYE_LEVEL_M, middle[2]]
    return turned_about_vertical(grounded * CAMERA_AXES + there, there, view.degrees)
