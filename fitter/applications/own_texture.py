"""A texture of one's own: an atlas to paint on, and what was painted laid on the body.

What is painted beside the body's islands does not count: each island is drawn on into its margin,
so that painting up to an edge is enough and seams stay closed.
"""

import colorsys

import cv2
import numpy as np
from jaxtyping import Bool, UInt8

from fitter.applications.atlas import drawn_on, triangles_of_texels
from fitter.applications.texture import SIZES
from fitter.body.model import BodyModel
from fitter.errors import InvalidInputError

LEAST_SIDE = 64
"""Texels: a smaller atlas shows nothing."""

TINT_OPACITY = 72
"""Of a part, of 255: what is painted beneath stays visible."""

LINE = (24, 24, 24, 255)
"""Red, green, blue and opacity of outlines and names."""

LEAST_NAMED_SHARE = 0.002
"""Of the atlas: smaller pieces of a part bear its name only if it has no larger one."""

NAMING_SIZE = 512
"""Texels a side at which places for names are looked for."""

_TEXT_HEIGHT = 0.45
"""Of OpenCV's letters, per 1024 texels."""


def painted_texture(
    painted: UInt8[np.ndarray, "h w 3"], model: BodyModel, *, field: str
) -> UInt8[np.ndarray, "n n 3"]:
    """Paint on the body's islands, drawn on into their margins.

    Parameters
    ----------
    painted
        sRGB levels in the layout of the model's atlas, rows from its top.
    model
        Whose atlas.
    field
        Name of the request field, for error messages.

    Raises
    ------
    InvalidInputError
        If it is not square, too small or too large.
    """
    height, width = painted.shape[:2]
    reason = None
    if height != width:
        reason = "the atlas is square"
    elif not LEAST_SIDE <= width <= SIZES[-1]:
        reason = f"the atlas has between {LEAST_SIDE} and {SIZES[-1]} a side"
    if reason is not None:
        raise InvalidInputError(
            code="texture-size",
            field=field,
            reason=f"The texture measures {width} x {height} texels; {reason}.",
            remedy="Paint on the atlas that comes with every texture.",
        )
    inside = triangles_of_texels(model, height) >= 0
    return drawn_on(inside, painted[inside])


def atlas_drawing(model: BodyModel, size: int) -> UInt8[np.ndarray, "n n 4"]:
    """The body's parts where the atlas has them, as a transparent layer: tints, outlines, names."""
    triangles = triangles_of_texels(model, size)
    # Of no triangle, the last entry: of no part.
    parts = np.append(model.part_of_triangle, -1)[triangles]
    tints = np.array([*map(_tint, range(len(model.part_names))), (0, 0, 0, 0)], dtype=np.uint8)
    drawing = tints[parts]
    drawing[_borders(parts)] = LINE
    step = max(1, size // NAMING_SIZE)
    coarse = parts[::step, ::step]
    for part, name in enumerate(model.part_names):
        for row, column in _places_for_names(coarse == part):
            _write(drawing, name.replace("_", " "), step * row, step * column)
    return drawing


def _tint(part: int) -> tuple[int, int, int, int]:
    """A hue a part: neighbours in the list of parts are far apart on the wheel (golden ratio)."""
    red, green, blue = colorsys.hsv_to_rgb((0.618034 * part) % 1.0, 0.8, 1.0)
    return round(255 * red), round(255 * green), round(255 * blue), TINT_OPACITY


def _borders(parts: np.ndarray) -> Bool[np.ndarray, "n n"]:
    """Texels of the body beside one of another part, or of none."""
    around = np.pad(parts, 1, constant_values=-1)
    differs = np.zeros(parts.shape, dtype=np.bool_)
    for neighbour in (around[1:-1, :-2], around[1:-1, 2:], around[:-2, 1:-1], around[2:, 1:-1]):
        differs |= neighbour != parts
    return differs & (parts >= 0)


def _places_for_names(texels: Bool[np.ndarray, "n n"]) -> list[tuple[int, int]]:
    """Row and column of the middle of the widest place of a part's pieces, for those to be named.

    These are the large ones, or else the largest.
    """
    count, labels, statistics, _ = cv2.connectedComponentsWithStats(texels.astype(np.uint8))
    areas = statistics[:, cv2.CC_STAT_AREA]
    pieces = [k for k in range(1, count) if areas[k] >= LEAST_NAMED_SHARE * texels.size]
    if not pieces and count > 1:
        pieces = [1 + int(np.argmax(areas[1:]))]
    places: list[tuple[int, int]] = []
    for piece in pieces:
        # Within a frame, so that the atlas' own edge counts as one of the piece.
        framed = np.pad((labels == piece).astype(np.uint8), 1)
        inner = cv2.distanceTransform(framed, cv2.DIST_L2, cv2.DIST_MASK_5)
        row, column = np.unravel_index(int(np.argmax(inner)), inner.shape)
        places.append((int(row) - 1, int(column) - 1))
    return places


def _write(drawing: UInt8[np.ndarray, "n n 4"], text: str, row: int, column: int) -> None:
    """Write with the middle there, within the drawing."""
    size = len(drawing)
    scale, thickness = _TEXT_HEIGHT * size / 1024, max(1, round(size / 1024))
    font = cv2.FONT_HERSHEY_SIMPLEX
    (width, height), _ = cv2.getTextSize(text, font, scale, thickness)
    left = int(np.clip(column - width / 2, 1, max(1, size - width - 1)))
    cv2.putText(drawing, text, (left, row + height // 2), font, scale, LINE, thickness, cv2.LINE_AA)
