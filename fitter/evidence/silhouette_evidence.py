"""What a segmentation says to the silhouette energy: its region, distances and outline."""

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float

from fitter.arrays import GreyImage, Mask, Points2D
from fitter.evidence.sampling import sample

# Outline points are taken this far apart: denser ones repeat each other.
_SPACING_PX = 3.0
# A point's normal is that of the chord to its neighbours this many spacings away.
_CHORD = 2
_SHORTEST_OUTLINE = 8


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SilhouetteEvidence:
    """The observed region.

    Attributes
    ----------
    mask
        (h, w) the person.
    signed_distance
        (h, w) pixels to the outline at each pixel's centre, positive outside.
    boundary_points, boundary_normals
        (b, 2) points of the outline in continuous pixels with outward unit normals; the picture's
        own border is no outline.
    boundary_spacing
        Pixels of outline each point stands for.
    occupied_rows, occupied_columns
        (h,), (w,) where the mask has pixels.
    """

    mask: Mask
    signed_distance: GreyImage
    boundary_points: Points2D
    boundary_normals: Points2D
    boundary_spacing: float
    occupied_rows: Bool[np.ndarray, " h"]
    occupied_columns: Bool[np.ndarray, " w"]

    def distance_at(self, points: Points2D) -> Float[np.ndarray, " k"]:
        """Signed distance at continuous pixels."""
        values, _ = sample(self.signed_distance, points)
        return values


def silhouette_evidence(mask: Mask) -> SilhouetteEvidence:
    """Prepare a segmentation."""
    points, normals = _outline(mask)
    return SilhouetteEvidence(
        mask=np.ascontiguousarray(mask),
        signed_distance=signed_distance(mask),
        boundary_points=points,
        boundary_normals=normals,
        boundary_spacing=_SPACING_PX,
        occupied_rows=np.asarray(mask.any(axis=1)),
        occupied_columns=np.asarray(mask.any(axis=0)),
    )


def signed_distance(mask: Mask) -> GreyImage:
    """Euclidean distance from pixel centres to the outline, positive outside.

    OpenCV measures to the nearest centre of the other kind; the outline runs half a pixel nearer.
    """
    region = np.ascontiguousarray(mask).view(np.uint8)
    outside = cv2.distanceTransform(1 - region, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    inside = cv2.distanceTransform(region, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    return np.where(mask, 0.5 - inside, outside - 0.5).astype(np.float32)


def _outline(mask: Mask) -> tuple[Points2D, Points2D]:
    height, width = mask.shape
    contours, _ = cv2.findContours(
        np.ascontiguousarray(mask).view(np.uint8), cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE
    )
    points: list[np.ndarray] = []
    normals: list[np.ndarray] = []
    for contour in contours:
        chain = contour[:, 0].astype(np.float64) + 0.5
        if len(chain) < _SHORTEST_OUTLINE:
            continue
        count = max(round(len(chain) / _SPACING_PX), _SHORTEST_OUTLINE)
        marks = (np.arange(count) * len(chain) / count).astype(int)
        picked = chain[marks]
        chord = np.roll(picked, -_CHORD, axis=0) - np.roll(picked, _CHORD, axis=0)
        # OpenCV runs outer outlines with the region on the right hand in a y-down picture, and
        # holes the other way round: the outward normal is the same turn of the chord for both.
        normal = np.stack([-chord[:, 1], chord[:, 0]], axis=1)
        length = np.linalg.norm(normal, axis=1)
        inner = (
            (length > 0)
            & (picked > 1.5).all(axis=1)
            & (picked[:, 0] < width - 1.5)
            & (picked[:, 1] < height - 1.5)
        )
        normal = normal[inner] / length[inner, None]
        # The chain runs through the centres of the region's last pixels, half a pixel inside.
        points.append(picked[inner] + 0.5 * normal)
        normals.append(normal)
    if not points:
        return np.empty((0, 2)), np.empty((0, 2))
    return np.concatenate(points), np.concatenate(normals)
