"""Hair that hangs over neck, shoulders or trunk, and hides what is behind it.

Hair has the colours of the scalp and hangs together with it in the picture. Cloth of the same
colour may touch it; but hair does not cover most of a person.
"""

import cv2
import numpy as np
from jaxtyping import Bool, Float, Integer

from fitter.arrays import Image, Mask, Vector3
from fitter.observation.colour import display_from_linear, linear_from_display
from fitter.render.rasterizer import Rendering

LEAST_SEEN = 40
"""Pixels of the scalp from which a colour of hair is learnt."""

COLOURS = 2
"""Colours of a scalp: hair and its light, hair and a band."""

LEAST_SHARE = 0.25
"""Of the seen scalp, that a colour of it counts as hair's."""

ALIKE = 2.5
"""Deviations up to which a pixel has the colour of hair."""

MOST_OF_BODY = 0.12
"""Share of the person below the head that hair may cover; more is cloth of its colour, as
a shirt seen from the front, which is a fifth of it."""

CHROMA, DARKEST_SHADE = 0.35, 0.06
"""Hair whose channels are in the same ratio to the face's within the first (of logarithms), and
brighter than this share of it, cannot be told from skin in the shade: it is left where it is."""

_DARKEST = 0.004
# Of linear light; below it noise dominates.
_DEVIATIONS = np.array([[8.0, 3.0, 3.0], [16.0, 6.0, 6.0]])
# Least and most of L, a, b (8 bits): light on hair changes its brightness most.


def loose_hair(
    rendering: Rendering,
    linear_rgb: Image,
    person: Mask,
    *,
    scalp: Bool[np.ndarray, " f"],
    face: Bool[np.ndarray, " f"],
) -> Mask:
    """Where hair hides the body below the head.

    Parameters
    ----------
    rendering
        The body at the picture's size.
    linear_rgb
        (h, w, 3) the picture in linear light.
    person
        (h, w) the pixels that show the person.
    scalp, face
        Which triangles hair grows on, and which are the rest of head and neck.
    """
    hidden = np.zeros(person.shape, dtype=bool)
    seen = rendering.silhouette & person
    on_scalp, on_face = (seen & own[rendering.face_ids] for own in (scalp, face))
    if np.count_nonzero(on_scalp) < LEAST_SEEN:
        return hidden
    lab = _lab(linear_rgb)
    below = seen & ~on_scalp & ~on_face
    for mean, deviation in _colours_of(lab[on_scalp]):
        if _may_be_skin(_linear(mean), linear_rgb[on_face]):
            continue
        alike = person & ((np.abs(lab - mean) / deviation).max(axis=2) < ALIKE)
        hanging = _connected(alike | on_scalp, on_scalp) & alike & below
        if np.count_nonzero(hanging) < MOST_OF_BODY * np.count_nonzero(below):
            hidden |= hanging
    return hidden


def _lab(linear_rgb: Image) -> Float[np.ndarray, "h w 3"]:
    levels = np.rint(255.0 * display_from_linear(np.clip(linear_rgb, 0.0, 1.0))).astype(np.uint8)
    return cv2.cvtColor(levels, cv2.COLOR_RGB2LAB).astype(np.float64)


def _linear(lab: Vector3) -> Vector3:
    levels = cv2.cvtColor(np.rint(lab).astype(np.uint8)[None, None], cv2.COLOR_LAB2RGB)
    return linear_from_display(levels[0, 0] / 255.0)


def _colours_of(
    seen: Float[np.ndarray, "k 3"],
) -> list[tuple[Vector3, Vector3]]:
    """Means and deviations of the colours of a scalp that cover enough of it."""
    label = _nearest_of_two(seen)
    found: list[tuple[Vector3, Vector3]] = []
    for each in range(COLOURS):
        own = seen[label == each]
        if len(own) >= LEAST_SHARE * len(seen):
            deviation = 1.4826 * np.median(np.abs(own - np.median(own, axis=0)), axis=0)
            found.append((np.median(own, axis=0), np.clip(deviation, *_DEVIATIONS)))
    return found


def _may_be_skin(hair: Vector3, face: Float[np.ndarray, "k 3"]) -> bool:
    """Whether a linear colour may also be the face's in the shade, which leaves chroma as it is."""
    if len(face) < LEAST_SEEN:
        return False
    skin = np.maximum(np.median(face, axis=0), _DARKEST)
    hair = np.maximum(hair, _DARKEST)
    alike = np.ptp(np.log(hair / skin)) < CHROMA
    return bool(alike) and float(hair.sum()) > DARKEST_SHADE * float(skin.sum())


def _nearest_of_two(seen: Float[np.ndarray, "k 3"]) -> Integer[np.ndarray, " k"]:
    """k-means from the two ends of the axis along which the colours differ most."""
    away = seen - seen.mean(axis=0)
    ends = away @ np.linalg.svd(away, full_matrices=False)[2][0] > 0.0
    _, labels, _ = cv2.kmeans(
        seen.astype(np.float32),
        COLOURS,
        ends.astype(np.int32),
        (cv2.TERM_CRITERIA_MAX_ITER, 10, 0.0),
        1,
        cv2.KMEANS_USE_INITIAL_LABELS,
    )
    return np.asarray(labels, dtype=np.intp).ravel()


def _connected(region: Mask, seeds: Mask) -> Mask:
    """The connected components of a region that hold a seed."""
    _, labels = cv2.connectedComponents(region.astype(np.uint8))
    holding = np.unique(labels[seeds & region])
    return np.isin(labels, holding[holding > 0])
