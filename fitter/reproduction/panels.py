"""A figure of the paper drawn anew: labelled pictures side by side."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import cv2
import numpy as np
from jaxtyping import UInt8

from fitter.arrays import Image, Mask, Vector3, Vertices
from fitter.export.display import to_levels
from fitter.export.views import (
    CANONICAL_DISTANCE_M,
    LABEL_COLOUR,
    framing_camera,
    turned_about_vertical,
    under_level_camera,
)
from fitter.parameters import CameraTilt
from fitter.render.camera import Camera


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Figure:
    """One of the paper's figures, drawn anew; ``differs`` says what is not as in the paper's.

    ``name`` is that of its file, ``picture`` (h, w, 3) sRGB levels.
    """

    name: str
    title: str
    caption: str
    differs: str
    picture: UInt8[np.ndarray, "h w 3"]

    @property
    def words(self) -> str:
        """Caption and differences, as Markdown."""
        return f"{self.caption}\n\n*Different:* {self.differs}"


Levels = UInt8[np.ndarray, "_ _ 3"]

HEIGHT_PX: Final = 380
"""Height of the panels of a row."""

BODY_WIDTH_PX: Final = 230

RED: Final = np.array([0.60, 0.10, 0.08])
GREEN: Final = np.array([0.16, 0.46, 0.14])
MAGENTA: Final = np.array([0.55, 0.10, 0.42])
"""Linear albedos of the bodies in the paper's Figs. 5 and 8."""

_LABEL_PX, _GAP_PX = 22, 8


def row(panels: Sequence[tuple[str, Levels]], *, height_px: int = HEIGHT_PX) -> Levels:
    """Panels brought to one height, from left to right, each with its label above it."""
    gap = np.full((height_px + _LABEL_PX, _GAP_PX, 3), 255, dtype=np.uint8)
    columns = [gap]
    for label, picture in panels:
        panel = _as_high(picture, height_px)
        heading = np.full((_LABEL_PX, panel.shape[1], 3), 255, dtype=np.uint8)
        cv2.putText(
            heading, label, (1, 15), cv2.FONT_HERSHEY_SIMPLEX, 0.42, LABEL_COLOUR, 1, cv2.LINE_AA
        )
        columns += [np.concatenate([heading, panel]), gap]
    return np.concatenate(columns, axis=1)


def stacked(rows: Sequence[Levels]) -> Levels:
    """Rows from top to bottom, on white paper as wide as the widest."""
    widest = max(each.shape[1] for each in rows)
    return np.concatenate(
        [
            np.pad(each, ((0, _GAP_PX), (0, widest - each.shape[1]), (0, 0)), constant_values=255)
            for each in rows
        ]
    )


def in_profile(
    vertices: Vertices, root: Vector3, tilt: CameraTilt | None, *, degrees: float = 90.0
) -> Vertices:
    """The posed body as an onlooker sees it who walked round it to the right of the picture.

    Its root lies :data:`CANONICAL_DISTANCE_M` before them, so that bodies can be compared in size.
    """
    turned = turned_about_vertical(under_level_camera(vertices, root, tilt), root, degrees)
    return turned - root + [0.0, 0.0, CANONICAL_DISTANCE_M]


def common_camera(bodies: Sequence[Vertices], *, width: int = BODY_WIDTH_PX) -> Camera:
    """One camera whose picture holds each of the bodies."""
    return framing_camera(np.concatenate(list(bodies)), width=width, height=HEIGHT_PX)


def tinted(picture: Image, mask: Mask, colour: Sequence[float], share: float = 0.55) -> Levels:
    """A picture with a region under a translucent display colour."""
    levels = np.array(picture, dtype=np.float64)
    levels[mask] = (1.0 - share) * levels[mask] + share * np.asarray(colour)
    return to_levels(levels)


def overlaps(body: Mask, observed: Mask) -> Levels:
    """As the paper's Fig. 4: yellow where both are, blue the picture's alone, red the body's."""
    levels = np.full((*body.shape, 3), 255, dtype=np.uint8)
    levels[body & observed] = (250, 215, 40)
    levels[observed & ~body] = (40, 70, 220)
    levels[body & ~observed] = (220, 40, 40)
    return levels


def _as_high(picture: Levels, height_px: int) -> Levels:
    height, width = picture.shape[:2]
    size = (max(1, round(width * height_px / height)), height_px)
    way = cv2.INTER_AREA if height_px < height else cv2.INTER_CUBIC
    return np.asarray(cv2.resize(picture, size, interpolation=way), dtype=np.uint8)
