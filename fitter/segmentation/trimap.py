"""The tri-map (section 3.2): sure foreground, sure background and the band between."""

from enum import IntEnum

import cv2
import numpy as np
from jaxtyping import Float, UInt8

from fitter.arrays import GreyImage, Image, Mask
from fitter.observation.maps import exact_distances, window_about

BAND_SHARE_OF_WIDTH = 0.05
"""The paper's: erode and dilate by 5 % of the picture's width."""

LEAST_BAND_SHARE_OF_BODY = 0.04
LARGEST_BAND_SHARE_OF_BODY = 0.08
"""In the paper's pictures the person fills the frame. In a tall narrow picture 5 % of the width is
less than the error of the first pose, in a wide empty one more than the body's breadth; so the band
is also kept between these shares of the silhouette's longer side: 7 and 14 cm on a standing adult.
"""

BONE_SHARE_OF_BODY = 0.012
"""Width of the sure foreground along a clicked bone: 2 cm on a standing adult, less than any limb.
Erosion by the band leaves nothing of the limbs, and GrabCut gives what it has no sample of to the
background."""

LEANING_SHARE = 0.5
"""Least depth inside the silhouette, as a share of the band, of pixels that start as foreground.
What the first body covers wrongly lies along its border; if GrabCut learns it as the person's
colour it stays, as the dark gap between the legs of a figure on a dark background did."""


SEEDED_BAND_SHARE_OF_BODY = 0.02
"""Half the width of the band about the detector's mask: three of its pixels, 3.5 cm on an adult."""

LEAST_SEEDED_BAND_PX = 2.0

LEAST_BONES_COVERED = 0.95
"""Share of the clicked bones that must lie inside the detector's mask."""


class TrimapLabel(IntEnum):
    """Labels of what is known about a pixel; the numbers are OpenCV's.

    The paper's tri-map has one uncertain label. Here the band has two, for the side where GrabCut
    starts a pixel; both are open to change.
    """

    BACKGROUND = cv2.GC_BGD
    FOREGROUND = cv2.GC_FGD
    LIKELY_BACKGROUND = cv2.GC_PR_BGD
    LIKELY_FOREGROUND = cv2.GC_PR_FGD


Trimap = UInt8[np.ndarray, "h w"]


def trimap(silhouette: Mask, bones: Float[np.ndarray, "b 2 2"], *, band: float) -> Trimap:
    """Labels by :class:`TrimapLabel` from a body's silhouette.

    Erosion and dilation by a disc are thresholds of the distance to the silhouette's border; the
    body may go on beyond the picture, whose border therefore erodes nothing.

    Parameters
    ----------
    silhouette
        (h, w) of the initial body, or of a later one with a narrower band.
    bones
        (b, 2, 2) both ends of clicked limbs, continuous pixels: sure foreground wherever they run,
        because the person was clicked there, while the silhouette is only a first guess. The band
        surrounds them too.
    band
        How far to erode and dilate, pixels.
    """
    skeleton = _skeleton(silhouette, bones)
    region = silhouette.astype(np.uint8)
    labels = np.full(silhouette.shape, TrimapLabel.BACKGROUND, dtype=np.uint8)
    if not (silhouette.any() or skeleton.any()):
        return labels
    # Beyond this window all is background, and no pixel inside is nearest to one beyond.
    window = window_about(region | skeleton, margin=int(np.ceil(band)) + 1)
    region, skeleton = region[window], skeleton[window]
    depth = _distance_to(1 - region)
    inner = np.full(region.shape, TrimapLabel.LIKELY_BACKGROUND, dtype=np.uint8)
    inner[_distance_to(region | skeleton) > band] = TrimapLabel.BACKGROUND
    inner[depth > LEANING_SHARE * band] = TrimapLabel.LIKELY_FOREGROUND
    inner[(depth > band) | (skeleton > 0)] = TrimapLabel.FOREGROUND
    labels[window] = inner
    return labels


def seeded_trimap(seed: GreyImage, bones: Float[np.ndarray, "b 2 2"]) -> Trimap | None:
    """Labels from the detector's mask, whose border is uncertain by a few of its pixels.

    Parameters
    ----------
    seed
        (h, w) probability that a pixel shows the person.
    bones
        As for :func:`trimap`.

    Returns
    -------
    None if the mask misses part of the person: clicked limbs run outside it.
    """
    person = seed > 0.5
    if not _covers(person, bones):
        return None
    band = max(LEAST_SEEDED_BAND_PX, SEEDED_BAND_SHARE_OF_BODY * body_size(person, bones))
    return trimap(person, bones, band=band)


def seeded_person(seed: GreyImage, bones: Float[np.ndarray, "b 2 2"]) -> Mask | None:
    """The detector's mask with the clicked bones; None as for :func:`seeded_trimap`."""
    person = seed > 0.5
    return person | (_skeleton(person, bones) > 0) if _covers(person, bones) else None


def _skeleton(silhouette: Mask, bones: Float[np.ndarray, "b 2 2"]) -> UInt8[np.ndarray, "h w"]:
    """1 along the bones, narrower than any limb."""
    drawn = np.zeros(silhouette.shape, dtype=np.uint8)
    thickness = max(1, round(BONE_SHARE_OF_BODY * body_size(silhouette, bones)))
    for start, end in np.rint(bones - 0.5).astype(int):  # OpenCV counts from pixel centres.
        cv2.line(drawn, start.tolist(), end.tolist(), 1, thickness=thickness)
    return drawn


def _covers(person: Mask, bones: Float[np.ndarray, "b 2 2"]) -> bool:
    """Whether nearly all of the bones' length lies inside the mask."""
    along = np.zeros(person.shape, dtype=np.uint8)
    for start, end in np.rint(bones - 0.5).astype(int):
        cv2.line(along, start.tolist(), end.tolist(), 1)
    drawn = along > 0
    return bool(drawn.any()) and float(person[drawn].mean()) >= LEAST_BONES_COVERED


def first_band(silhouette: Mask, bones: Float[np.ndarray, "b 2 2"]) -> float:
    """Width of the band around the initial body, pixels."""
    size = body_size(silhouette, bones)
    return float(
        np.clip(
            BAND_SHARE_OF_WIDTH * silhouette.shape[1],
            LEAST_BAND_SHARE_OF_BODY * size,
            LARGEST_BAND_SHARE_OF_BODY * size,
        )
    )


def body_size(silhouette: Mask, bones: Float[np.ndarray, "b 2 2"]) -> float:
    """The longer side of what silhouette and bones cover, pixels."""
    rows, columns = np.flatnonzero(silhouette.any(axis=1)), np.flatnonzero(silhouette.any(axis=0))
    x = np.concatenate([columns, bones[:, :, 0].reshape(-1)])
    y = np.concatenate([rows, bones[:, :, 1].reshape(-1)])
    return float(max(np.ptp(x), np.ptp(y)) + 1.0) if x.size else 1.0


def is_uncertain(labels: Trimap) -> Mask:
    """(h, w) the band."""
    return labels >= TrimapLabel.LIKELY_BACKGROUND


def trimap_picture(labels: Trimap) -> Image:
    """(h, w, 3) float picture as in the paper's Fig. 3b: white inside, grey band, black outside."""
    greys = np.array([0.0, 1.0, 0.5, 0.5], dtype=np.float32)[labels]
    return np.repeat(greys[:, :, None], 3, axis=2)


def _distance_to(region: UInt8[np.ndarray, "h w"]) -> Float[np.ndarray, "h w"]:
    """Distance of each pixel to the region's nearest, in pixels; infinite if it is empty."""
    if not region.any():
        return np.full(region.shape, np.inf, dtype=np.float32)
    return exact_distances(1 - region)
