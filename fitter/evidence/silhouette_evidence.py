"""Evidence of the silhouette energy: region, distances and outline of a segmentation."""

from dataclasses import dataclass, replace

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32
from scipy.special import ndtri

from fitter.arrays import GreyImage, Mask, Points2D
from fitter.observation.maps import exact_distances, sample, window_about

# Outline points are taken this far apart: denser ones repeat each other.
_SPACING_PX = 3.0
_SHORTEST_OUTLINE = 8
# The mask is smoothed by this much and the outline taken where it is one half: between pixels,
# without the staircase. On a disc the points are then off by 0.1 px (0.27 px on the staircase) and
# the normals by 3 degrees; a finger 5 px thick loses 0.4 px of its radius, an arm 0.03 px.
_SMOOTHING_PX = 1.5
# Where the smoothed mask is almost flat, the step to one half cannot be trusted.
_FLATTEST = 0.02
# A thread of 2 px never reaches one half when smoothed: its outline is left out, not guessed.
_FARTHEST_FROM_HALF = 0.2


FullnessMap = Float32[np.ndarray, "h w 2"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SilhouetteEvidence:
    """The observed region.

    Attributes
    ----------
    mask
        (h, w) the person.
    signed_distance
        (h, w) pixels to the outline at each pixel's centre, positive outside.
    confidence
        (h, w) how much an unmatched pixel or outline point counts, in [0, 1].
    cloth
        (h, w) probability that what is seen there is loose cloth; off the person, that of their
        nearest pixel; None where clothes are tight.
    fullness
        (h, w, 2) how far what covers the upper body and the legs usually stands off there, as a
        share of the mean ease; None where clothes are tight.
    boundary_points, boundary_normals
        (b, 2) points of the outline in continuous pixels, between the pixels' centres, with
        outward unit normals; the picture's own border is not part of the outline.
    boundary_spacing
        Pixels of outline each point stands for.
    occupied_rows, occupied_columns
        (h,), (w,) where the mask has pixels.
    """

    mask: Mask
    signed_distance: GreyImage
    confidence: GreyImage
    boundary_points: Points2D
    boundary_normals: Points2D
    boundary_spacing: float
    occupied_rows: Bool[np.ndarray, " h"]
    occupied_columns: Bool[np.ndarray, " w"]
    cloth: GreyImage | None = None
    fullness: FullnessMap | None = None

    def cloth_at(self, points: Points2D) -> Float[np.ndarray, " k"]:
        """Probability of loose cloth at continuous pixels."""
        if self.cloth is None:
            return np.zeros(len(points))
        return sample(self.cloth, points)[0]

    def fullness_at(self, points: Points2D) -> Float[np.ndarray, "k 2"]:
        """Usual distance of clothes at continuous pixels, 1 where nothing is known."""
        if self.fullness is None:
            return np.tile([1.0, 0.0], (len(points), 1))
        return np.stack([sample(self.fullness[..., k], points)[0] for k in range(2)], axis=1)

    def confidence_at(self, points: Points2D) -> Float[np.ndarray, " k"]:
        """Confidence at continuous pixels."""
        return sample(self.confidence, points)[0]

    @property
    def doubtful(self) -> Mask:
        """(h, w) where it cannot be told what is seen."""
        return self.confidence == 0.0

    def doubting(self, region: Mask) -> "SilhouetteEvidence":
        """The same with no confidence in a region (h, w)."""
        return replace(self, confidence=np.where(region, np.float32(0.0), self.confidence))

    def distance_at(self, points: Points2D) -> Float[np.ndarray, " k"]:
        """Signed distance at continuous pixels."""
        values, _ = sample(self.signed_distance, points)
        return values


def silhouette_evidence(
    mask: Mask, confidence: GreyImage | None = None, cloth: GreyImage | None = None
) -> SilhouetteEvidence:
    """Prepare a segmentation; cloth, where there is any, has the same ease everywhere."""
    points, normals = _outline(mask)
    return SilhouetteEvidence(
        mask=np.ascontiguousarray(mask),
        signed_distance=signed_distance(mask),
        confidence=np.ones(mask.shape, dtype=np.float32) if confidence is None else confidence,
        boundary_points=points,
        boundary_normals=normals,
        boundary_spacing=_SPACING_PX,
        occupied_rows=np.asarray(mask.any(axis=1)),
        occupied_columns=np.asarray(mask.any(axis=0)),
        cloth=cloth,
        fullness=None if cloth is None else uniform_fullness(mask.shape),
    )


def uniform_fullness(shape: tuple[int, ...]) -> FullnessMap:
    """(h, w, 2) the mean ease everywhere."""
    fullness = np.zeros((*shape, 2), dtype=np.float32)
    fullness[..., 0] = 1.0
    return fullness


def signed_distance(mask: Mask) -> GreyImage:
    """Euclidean distance from pixel centres to the outline, positive outside.

    OpenCV measures to the nearest pixel centre of the other kind; the outline is half a pixel
    nearer.
    """
    region = np.ascontiguousarray(mask).view(np.uint8)
    signed = exact_distances(1 - region) - np.float32(0.5)
    if mask.any():
        # The nearest pixel outside lies within a pixel of the mask's rectangle.
        window = window_about(mask, margin=1)
        inside = exact_distances(region[window])
        signed[window] = np.where(mask[window], np.float32(0.5) - inside, signed[window])
    return signed


def _outline(mask: Mask) -> tuple[Points2D, Points2D]:
    height, width = mask.shape
    region = np.ascontiguousarray(mask).view(np.uint8)
    contours, _ = cv2.findContours(region, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    picked: list[np.ndarray] = []
    for contour in contours:
        chain = contour[:, 0].astype(np.float64) + 0.5
        if len(chain) >= _SHORTEST_OUTLINE:
            count = max(round(len(chain) / _SPACING_PX), _SHORTEST_OUTLINE)
            picked.append(chain[(np.arange(count) * len(chain) / count).astype(int)])
    if not picked:
        return np.empty((0, 2)), np.empty((0, 2))
    points = np.concatenate(picked)
    inside = (points > 1.5).all(axis=1) & (points < [width - 1.5, height - 1.5]).all(axis=1)
    return _onto_the_level_set(mask, points[inside])


def _onto_the_level_set(
    mask: Mask, points: Points2D
) -> tuple[Float[np.ndarray, "found 2"], Float[np.ndarray, "found 2"]]:
    """Move points along the smoothed mask's slope to where it is one half; and outward normals.

    Across a straight outline the smoothed mask is the normal distribution function of the distance,
    whose inverse gives the distance directly; the second step corrects for curvature.
    """
    smooth = cv2.GaussianBlur(
        mask.astype(np.float32), (0, 0), _SMOOTHING_PX, borderType=cv2.BORDER_REPLICATE
    )
    for _ in range(2):
        coverage, normals = _coverage_and_normals(smooth, points)
        inward = _SMOOTHING_PX * ndtri(np.clip(coverage, _FLATTEST, 1.0 - _FLATTEST))
        points = points + inward[:, None] * normals
    coverage, normals = _coverage_and_normals(smooth, points)
    found = np.abs(coverage - 0.5) < _FARTHEST_FROM_HALF
    return points[found], normals[found]


def _coverage_and_normals(
    smooth: GreyImage, points: Points2D
) -> tuple[Float[np.ndarray, " k"], Points2D]:
    coverage, slopes = sample(smooth, points)
    steepness = np.linalg.norm(slopes, axis=1, keepdims=True)
    return coverage, -slopes / np.maximum(steepness, np.finfo(np.float64).tiny)
