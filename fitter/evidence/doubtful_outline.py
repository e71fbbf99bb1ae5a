"""Parts of an outline that may be something else's: what covers the person, or adjoins them.

A segmentation knows two values, and a thing before a person is given one or the other: a box before
the hips is taken for the person, a bag before an arm for background. Its border is then no outline
of the body, and draws it outward or inward. Near a body that was fitted there is a third value,
*cannot tell*: around what is taken for the person and lies off the body, and around what lies well
inside the body and is not taken for the person. No outline and no edge counts there.
"""

from collections.abc import Sequence
from typing import Final

import cv2
import numpy as np
from jaxtyping import Float

from fitter.arrays import GreyImage, Image, Mask
from fitter.evidence.loose_outline import FARTHEST_M
from fitter.evidence.silhouette_evidence import SilhouetteEvidence
from fitter.render.rasterizer import Rendering

OFF_M: Final = 0.015
"""Distance from the body's outline beyond which a region contradicts it. Of 52 pictures of people
in underwear (tuning halves) 9 have such a region, with points proposed 5."""

LEAST_AREA_M2: Final = 3e-4
"""Smaller regions are speckle."""

AROUND_M: Final = 0.035
"""Margin of doubt around such a region: to the body, and past its next corner."""

THING_M: Final = 0.5
"""A thing that covers the person reaches at most so far from where it sticks out."""

LEAST_SPREAD, DEVIATIONS = 0.03, 2.5
"""A thing's colours: so many standard deviations about the mean, and the least deviation."""

APART_M: Final = 0.25
"""From what sticks out, the rest of the person begins so far away: past a thing before them."""

OWN_SHARE: Final = 0.5
"""Least share of the rest of the person in the colours of what sticks out, if that is their own.
Bellies beyond the model's have 0.65 and more; boxes and bags of 24 pictures (tuning half) at most
0.22, the arm of another up to 0.84."""

BROAD_M: Final = 0.1
"""Breadth, area over reach, of what the person themselves may be: an arm before them has 0.04 to
0.07, a belly 0.14 and more."""

SURE_CONFIDENCE: Final = 0.5
"""Confidence above which an outline is judged: at hair and hands it counts for less anyway."""


def doubtful_outline(silhouette: SilhouetteEvidence, rendering: Rendering, display: Image) -> Mask:
    """(h, w) where it cannot be told whether the outline seen is the person's.

    Parameters
    ----------
    silhouette
        The region taken for the person. Where it is loose cloth it may lie far off the body.
    rendering
        A body fitted to the picture.
    display
        (h, w, 3) display values in [0, 1]. A thing whose border sticks out is followed by its
        colour to where it lies before the person.
    """
    pixels_per_metre = scale_of(rendering)
    sure = silhouette.confidence > SURE_CONFIDENCE
    spilt, missed = off_the_body(silhouette, rendering, sure)
    region = missed | spilt
    if not region.any():
        return region
    near = _distance(~spilt) <= THING_M * pixels_per_metre
    for part in _parts(spilt):
        region |= _thing(part, silhouette.mask & sure, near, display)
    return _distance(~region) <= AROUND_M * pixels_per_metre


def off_the_body(
    silhouette: SilhouetteEvidence, rendering: Rendering, where: Mask
) -> tuple[Mask, Mask]:
    """Pixels that contradict a body, within ``where`` (h, w) and without speckle.

    Returns
    -------
    (h, w) what is taken for the person and lies off the body, and (h, w) what lies well inside the
    body and is not taken for the person.
    """
    pixels_per_metre = scale_of(rendering)
    body, person = rendering.silhouette, silhouette.mask
    off_px = OFF_M * pixels_per_metre
    reach: float | GreyImage = off_px
    if silhouette.cloth is not None:
        reach = np.where(silhouette.cloth > 0.5, FARTHEST_M * pixels_per_metre, off_px)
    spilt = person & (_distance(~body) > reach) & where
    missed = body & ~person & (_distance(body) > off_px) & where
    least_px = LEAST_AREA_M2 * pixels_per_metre**2
    return _without_speckle(spilt, least_px), _without_speckle(missed, least_px)


def outgrown_m(
    silhouette: SilhouetteEvidence, rendering: Rendering, where: Mask, display: Image
) -> float:
    """Distance by which the person's own outline lies off a body, metres; 0 where it does not.

    An outline beyond the model is no evidence of a thing before the person: unusual people have one
    too, such as a pregnant woman who is seen from the side. A thing has colours of its own, and
    arms are narrow; what is broad and has the colours of the person's rest belongs to them.

    Parameters
    ----------
    silhouette, rendering, display
        As in :func:`doubtful_outline`.
    where
        (h, w) what is looked at.
    """
    spilt, _ = off_the_body(silhouette, rendering, where)
    pixels_per_metre = scale_of(rendering)
    off = _distance(~rendering.silhouette)
    person = silhouette.mask & rendering.silhouette
    reached = 0.0
    for part in _parts(spilt):
        reach_m = float(off[part].max()) / pixels_per_metre
        is_broad = np.count_nonzero(part) >= BROAD_M * reach_m * pixels_per_metre**2
        rest = person & (_distance(~part) > APART_M * pixels_per_metre)
        if is_broad and rest.any() and np.mean(_alike(part, display)[rest]) >= OWN_SHARE:
            reached = max(reached, reach_m)
    return reached


def scale_of(rendering: Rendering) -> float:
    """Pixels per metre at the body's distance."""
    return rendering.camera.focal_length_px / float(rendering.vertices[:, 2].mean())


def _thing(spilt: Mask, person: Mask, near: Mask, display: Image) -> Mask:
    """Pixels with a region's colours that are connected with it, within the person.

    The region alone where that goes on beyond what is near: then it has the person's colours.
    """
    alike = _alike(spilt, display) & person
    _, labels = cv2.connectedComponents((spilt | alike).astype(np.uint8), connectivity=4)
    grown = np.isin(labels, np.unique(labels[spilt]))
    return grown if near[grown].all() else spilt


def _alike(spilt: Mask, display: Image) -> Mask:
    """Pixels with a region's colours."""
    colours = display[spilt]
    spread = np.maximum(colours.std(axis=0), LEAST_SPREAD)
    return (np.abs(display - colours.mean(axis=0)) < DEVIATIONS * spread).all(axis=2)


def _distance(region: Mask) -> GreyImage:
    """Distance of each pixel of a region to the nearest that is not in it, pixels."""
    return cv2.distanceTransform(region.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)


def _parts(region: Mask) -> list[Mask]:
    """Its connected parts."""
    count, labels = cv2.connectedComponents(region.astype(np.uint8), connectivity=8)
    return [labels == each for each in range(1, count)]


def _without_speckle(region: Mask, least_px: float) -> Mask:
    """Its connected parts of at least so many pixels."""
    _, labels, statistics, _ = cv2.connectedComponentsWithStats(
        region.astype(np.uint8), connectivity=8
    )
    kept = statistics[:, cv2.CC_STAT_AREA] >= least_px
    kept[0] = False
    return kept[np.asarray(labels, dtype=np.int32)]


DOUBTFUL_CONFIDENCE = 0.05
"""Weight left to an outline in a doubtful region. The model has no hair, and its hands are relaxed
while people's may not be. Two centimetres of hair all around make a head a tenth larger: with full
weight a body leaned forward to bring its head nearer to the camera."""


def outline_confidence(
    height: int, width: int, regions: Sequence[Float[np.ndarray, "_ 2"]], *, margin_px: float
) -> GreyImage:
    """A map of weights, 1 except around each region.

    Parameters
    ----------
    height, width
        Of the picture.
    regions
        Projected vertices of each doubtful part, continuous pixels; their convex hulls count.
    margin_px
        How far around each hull.
    """
    doubtful = np.zeros((height, width), dtype=np.uint8)
    for region in regions:
        # OpenCV counts from pixel centres.
        hull = cv2.convexHull(np.rint(region - 0.5).astype(np.int32))
        cv2.fillConvexPoly(doubtful, hull, 1)
    distance = cv2.distanceTransform(1 - doubtful, cv2.DIST_L2, cv2.DIST_MASK_5)
    near = (distance <= margin_px) if doubtful.any() else np.zeros_like(doubtful, dtype=bool)
    return np.where(near, DOUBTFUL_CONFIDENCE, 1.0).astype(np.float32)
