"""The texture atlas: which point of the body's surface each texel shows.

Texture coordinates are the body model's (MakeHuman's layout), from the atlas' lower left corner;
rows of a picture count from its top, so that texel (row, column) has its centre at
((column + 0.5) / size, 1 - (row + 0.5) / size).
"""

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, Integer, UInt8

from fitter.body.model import BodyModel
from fitter.render.camera import Camera
from fitter.render.rasterizer import render

MARGIN_SHARE = 16 / 1024
"""Width of the margin of colour around an island, as a share of the side: a renderer that averages
texels (four levels of mipmaps) then meets no seam."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Atlas:
    """The texels that lie on the body.

    Attributes
    ----------
    size
        Side of the square atlas, texels.
    inside
        (size, size) which texels lie on the body.
    triangles
        (t,) the triangle each of those lies on, in reading order.
    weights
        (t, 3) its barycentric coordinates there.
    """

    size: int
    inside: Bool[np.ndarray, "n n"]
    triangles: Integer[np.ndarray, " t"]
    weights: Float[np.ndarray, "t 3"]


def atlas_of(model: BodyModel, size: int) -> Atlas:
    """The atlas of a body model, ``size`` texels wide and high."""
    corners = _corners(model, size)
    # A flat mesh one metre before a camera of one pixel a metre is its own picture.
    flat = np.column_stack([corners, np.ones(len(corners))])
    camera = Camera(focal_length_px=1.0, centre_x=0.0, centre_y=0.0, width=size, height=size)
    ids = render(flat, model.uv_triangles, camera).face_ids
    inside = ids >= 0
    triangles = ids[inside]
    rows, columns = np.nonzero(inside)
    texels = np.stack([columns + 0.5, rows + 0.5], axis=1)
    return Atlas(
        size=size,
        inside=inside,
        triangles=triangles,
        weights=barycentric(texels, triangles, corners[model.uv_triangles]),
    )


def _corners(model: BodyModel, size: int) -> Float[np.ndarray, "u 2"]:
    """Texture coordinates as pixels of a picture of the atlas."""
    return np.stack([size * model.uv[:, 0], size * (1.0 - model.uv[:, 1])], axis=1)


def drawn_on(
    inside: Bool[np.ndarray, "n n"], levels: UInt8[np.ndarray, "t ..."]
) -> UInt8[np.ndarray, "n n ..."]:
    """A picture of the atlas from the levels of its texels, in reading order.

    Each island is drawn on into its margin; what lies beyond is black.
    """
    picture = np.zeros((*inside.shape, *levels.shape[1:]), dtype=np.uint8)
    picture[inside] = levels
    outside = (~inside).astype(np.uint8)
    distance, labels = cv2.distanceTransformWithLabels(
        outside, cv2.DIST_L2, cv2.DIST_MASK_5, labelType=cv2.DIST_LABEL_PIXEL
    )
    nearest = np.asarray(labels, dtype=np.intp)
    # Connected components of the texels inside; the texels themselves tell which label is which.
    of_label = np.zeros(int(nearest.max()) + 1, dtype=np.intp)
    of_label[nearest[inside]] = np.arange(len(levels))
    margin = (outside > 0) & (distance <= MARGIN_SHARE * len(inside))
    picture[margin] = levels[of_label[nearest[margin]]]
    return picture


def barycentric(
    points: Float[np.ndarray, "t 2"],
    triangles: Integer[np.ndarray, " t"],
    corners: Float[np.ndarray, "f 3 2"],
) -> Float[np.ndarray, "t 3"]:
    """Coordinates of points within their triangles; on an edge to rounding, never below zero.

    The doubled area opposite a corner, (b - p) x (c - p), is b x c + p x (b - c).
    """
    (ahead_x, ahead_y), (behind_x, behind_y) = (
        np.roll(corners, shift, axis=1).T for shift in (-1, 1)
    )
    constant = ahead_x * behind_y - ahead_y * behind_x
    along_x, along_y = ahead_x - behind_x, ahead_y - behind_y
    x, y = points.T
    opposite = np.stack(
        [
            constant[k, triangles] + x * along_y[k, triangles] - y * along_x[k, triangles]
            for k in range(3)
        ]
    )
    weights = np.maximum(opposite * np.sign(opposite.sum(axis=0)), 0.0)
    return np.ascontiguousarray((weights / weights.sum(axis=0)).T)
