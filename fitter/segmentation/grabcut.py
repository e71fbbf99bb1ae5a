"""GrabCut from the tri-map (section 3.2, reference [18])."""

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import UInt8

from fitter.arrays import Image, Mask
from fitter.errors import InvalidInputError
from fitter.remarks import FitWarning
from fitter.segmentation.trimap import Trimap, TrimapLabel, is_uncertain, trimap

ITERATIONS = 4
"""The borders move little after the third."""

COARSE_PIXELS = 50_000
"""Where GrabCut learns its colours. Most of its time goes into cutting the broad band over and
again: on a 392x1018 painting 1.6 s at full size; 0.15 s at a third of it, with another 0.14 s for
one cut at full size of the narrow band that is then still open. Overlap of both results 0.97."""

REOPENED_PX = 2.0
"""How many coarse pixels to each side of the coarse border the full-size cut may move it."""

SEED = 20090927
"""GrabCut starts its mixtures by k-means on random numbers: a fixed seed, the same result."""

SURROUNDINGS_SHARE = 0.15
"""How much sure background to show GrabCut around the band, as a share of the band's longer side:
the background beside the person says more of what must be told from the skin than all the rest,
and the time grows with the area."""

HOLE_SHARE = 0.002
"""Holes below this share of the person's area are speckle (a buckle, a highlight); larger ones are
gaps between arm and trunk."""

LEAST_CONTRAST = 0.01
"""Standard deviation of display values below which there is nothing to see: 8-bit rounding and
JPEG noise on a blank wall."""

DECIDED_SHARE = 0.02
"""Where all but this share of the band went to one side, the colours did not tell the sides apart.
From a true person the band falls about half to each."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Segmentation:
    """The observed silhouette.

    Attributes
    ----------
    mask
        (h, w) foreground.
    warnings
        What makes it doubtful.
    """

    mask: Mask
    warnings: tuple[FitWarning, ...]


def segment(display: Image, labels: Trimap) -> Segmentation:
    """Cut the person out of the picture.

    GrabCut sees only the surroundings of the band. Kept of its result is what hangs together with
    the sure foreground, with speckle holes filled.

    Parameters
    ----------
    display
        (h, w, 3) display values in [0, 1]: the colour distances GrabCut was made for.
    labels
        The tri-map.

    Raises
    ------
    InvalidInputError
        ``person-not-found`` if there is nothing to tell the person from.
    """
    if not (labels == TrimapLabel.FOREGROUND).any():
        reason = "No part of the person lies inside the picture."
        raise _no_person(reason)
    window = _window(labels)
    if display[window].std(axis=(0, 1)).max() < LEAST_CONTRAST:
        reason = "The picture has one colour around the clicked points."
        raise _no_person(reason)
    mask = np.zeros(labels.shape, dtype=np.bool_)
    mask[window] = _foreground(display[window], labels[window])
    mask = _without_speckle(mask, labels == TrimapLabel.FOREGROUND)
    return Segmentation(mask=mask, warnings=(*_doubts(mask, labels), *border_warnings(mask)))


def border_warnings(mask: Mask) -> tuple[FitWarning, ...]:
    """What the silhouette, found or sent, tells of the picture: a body cut off by its border."""
    cut = [
        side
        for side, line in (
            ("top", mask[0]),
            ("bottom", mask[-1]),
            ("left", mask[:, 0]),
            ("right", mask[:, -1]),
        )
        if line.any()
    ]
    if not cut:
        return ()
    return (
        FitWarning(
            code="body-outside-picture",
            message=(
                f"The person reaches the {' and the '.join(cut)} border of the picture. What lies "
                "outside is inferred from the rest."
            ),
        ),
    )


def _doubts(mask: Mask, labels: Trimap) -> tuple[FitWarning, ...]:
    band = mask[is_uncertain(labels)]
    if band.size == 0 or DECIDED_SHARE < band.mean() < 1.0 - DECIDED_SHARE:
        return ()
    return (
        FitWarning(
            code="segmentation-doubtful",
            message=(
                "The person could not be told from the background by colour; the silhouette is "
                "little more than the first guess. Sending a mask would help."
            ),
        ),
    )


def _no_person(reason: str) -> InvalidInputError:
    return InvalidInputError(
        code="person-not-found",
        field="image",
        reason=reason,
        remedy="Check that the points lie on the person, or send a mask.",
    )


def _window(labels: Trimap) -> tuple[slice, slice]:
    """Rows and columns of all that is not sure background, with some of that around."""
    rows = np.flatnonzero((labels != TrimapLabel.BACKGROUND).any(axis=1))
    columns = np.flatnonzero((labels != TrimapLabel.BACKGROUND).any(axis=0))
    size = max(rows[-1] - rows[0], columns[-1] - columns[0]) + 1
    margin = int(np.ceil(SURROUNDINGS_SHARE * size))
    return (
        slice(max(0, rows[0] - margin), rows[-1] + 1 + margin),
        slice(max(0, columns[0] - margin), columns[-1] + 1 + margin),
    )


def _foreground(display: Image, labels: Trimap) -> Mask:
    """GrabCut on a reduced picture, then one cut of the border at full size."""
    factor = int(np.ceil(np.sqrt(labels.size / COARSE_PIXELS)))
    picture = np.ascontiguousarray(np.rint(display[:, :, ::-1] * 255.0), dtype=np.uint8)
    coarse_labels = _reduced(labels, factor)
    if not all((coarse_labels == known).any() for known in (0, 1)):
        # The person fills the picture, or is a few pixels: no samples of one side to learn from.
        return labels != TrimapLabel.BACKGROUND
    height, width = coarse_labels.shape
    coarse_picture = cv2.resize(
        picture[: height * factor, : width * factor], (width, height), interpolation=cv2.INTER_AREA
    )
    models = np.zeros((1, 65)), np.zeros((1, 65))
    cv2.setRNGSeed(SEED)
    coarse = _cut(coarse_picture, coarse_labels, models, ITERATIONS, cv2.GC_INIT_WITH_MASK)
    if factor == 1:
        return coarse
    return _cut(picture, _reopened(coarse, labels, factor), models, 1, cv2.GC_EVAL_FREEZE_MODEL)


def _cut(
    picture: UInt8[np.ndarray, "h w 3"],
    labels: Trimap,
    models: tuple[np.ndarray, np.ndarray],
    iterations: int,
    mode: int,
) -> Mask:
    """One call of OpenCV's GrabCut; the colour models are filled or read, as ``mode`` says."""
    states = labels.copy()
    # The rectangle has no meaning with a mask.
    cv2.grabCut(picture, states, (0, 0, 0, 0), *models, iterations, mode)
    return (states == TrimapLabel.FOREGROUND) | (states == TrimapLabel.LIKELY_FOREGROUND)


def _reduced(labels: Trimap, factor: int) -> Trimap:
    """Labels of blocks: bones stay, and only pure background is sure background."""
    height, width = labels.shape[0] // factor, labels.shape[1] // factor
    blocks = labels[: height * factor, : width * factor]
    blocks = blocks.reshape(height, factor, width, factor)
    reduced = np.full((height, width), TrimapLabel.LIKELY_BACKGROUND, dtype=np.uint8)
    for label, enough in (
        (TrimapLabel.LIKELY_FOREGROUND, np.all),
        (TrimapLabel.BACKGROUND, np.all),
        (TrimapLabel.FOREGROUND, np.any),
    ):
        reduced[enough(blocks == label, axis=(1, 3))] = label
    return reduced


def _reopened(coarse: Mask, labels: Trimap, factor: int) -> Trimap:
    """A tri-map with a narrow band along the coarse border; what was sure stays sure.

    Also open is where the coarse cut took for the person what the tri-map leaned against: a gap
    of a few coarse pixels between the legs costs more border than it holds colour there, and not
    at full size.
    """
    # Repeating the last row and column covers what the blocks left over at the border.
    rows = np.minimum(np.arange(labels.shape[0]) // factor, coarse.shape[0] - 1)
    columns = np.minimum(np.arange(labels.shape[1]) // factor, coarse.shape[1] - 1)
    enlarged = coarse[np.ix_(rows, columns)]
    reopened = trimap(enlarged, np.zeros((0, 2, 2)), band=REOPENED_PX * factor)
    reopened[enlarged & (labels == TrimapLabel.LIKELY_BACKGROUND)] = TrimapLabel.LIKELY_FOREGROUND
    sure = ~is_uncertain(labels)
    reopened[sure] = labels[sure]
    return reopened


def _without_speckle(mask: Mask, sure: Mask) -> Mask:
    """What is connected to the sure foreground, without small holes."""
    _, regions = cv2.connectedComponents(mask.astype(np.uint8), connectivity=8)
    kept = np.unique(regions[sure & mask])
    mask = np.isin(regions, kept[kept > 0])
    count, holes, statistics, _ = cv2.connectedComponentsWithStats(
        (~mask).astype(np.uint8), connectivity=4
    )
    small = statistics[:, cv2.CC_STAT_AREA] < HOLE_SHARE * mask.sum()
    small[0] = False
    return mask | small[holes] if count > 1 else mask
