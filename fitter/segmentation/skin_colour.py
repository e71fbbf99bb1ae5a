"""Bare skin in a picture, by the colours of the person's own face and hands.

Balan and Black, "The Naked Truth", ECCV 2008: skin bounds the body tightly, clothes only
from outside. The colour of a person's skin is not known in advance, but the clicks say where the
face is: skin's colour is learnt from its pixels, and from hands that agree with it; under a mask
from what has the colour of hands or neck. The colours of clothes and hair are learnt from the rest
of the person. A pixel is then skin with probability

    P = π f_skin / (π f_skin + (1 - π) f_other),

where π is how often that part of the body is bare on people who say that their clothes are loose.
Colours are compared by the logarithms of red and blue over green, which shade does not change, and,
with a wide tolerance, by the logarithm of brightness.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32, Integer

from fitter.arrays import GreyImage, Image, Mask, Points2D
from fitter.segmentation.colour_mixture import ColourMixture, first_mixture, relearnt_mixture

BARE_SHARE: Mapping[str, float] = {
    "head": 0.8, "neck": 0.7, "hand": 0.9, "forearm": 0.5, "upper_arm": 0.25, "chest": 0.1,
    "spine": 0.05, "pelvis": 0.03, "thigh": 0.15, "shin": 0.35, "foot": 0.4,
}  # fmt: skip
"""Probability that a part is bare on people in loose clothes, by its name without the side.
Guesses: low on the trunk, so that cloth of the skin's colour is not mistaken for skin."""

FACE_RADIUS_M = 0.04
"""Around the nose: cheeks, lips, the lower forehead. Hair begins farther out."""

STEPS = 60.0
"""Steps per unit of the logarithm in which features are counted, about as fine as the 8-bit steps
of :mod:`fitter.segmentation.colour_mixture`."""

LEAST_SAMPLES = 40
"""Fewest pixels of face or hands from which a colour is learnt."""

_MOSTLY_BARE, _COVERED = 0.6, 0.005
# Where no colour tells, only head, neck and hands are taken for bare: many pixels that are
# bare with a small probability each outweigh all that is known of loose clothes.

_DARKEST = 0.004
# Added to linear light before logarithms are taken: below it noise and compression dominate.
_SHADE = 0.25
# Share of the face's brighter half's brightness: anything darker is hair, brow or nostril.
_CHROMA_DEVIATION = 0.07
_BRIGHTNESS_DEVIATION = 0.8
# Smallest deviations of the logarithms: compression and redness; a terminator and a highlight.
_WIDE, _WIDE_SHARE = 2.0, 0.1
_UNUSUAL = 3.0
# Deviations at which a colour is at first taken for something other than skin.
_IN_SIGHT, _CLEARLY_MORE = 0.15, 0.5
# Least share of a masked face that is in sight; by how many places more a colour is seen.
_ROUNDS = 3
_ODD_SHARE, _ODD_NATS = 0.05, 13.5
# Colours of neither side: uniform over three by three by six units of the logarithms.
_MOST_NATS = 5.0
_SMOOTHING_M = 0.008

Features = Float32[np.ndarray, "s 3"]
SomeFeatures = Float32[np.ndarray, "_ 3"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SkinMap:
    """Map of where the person is bare.

    Attributes
    ----------
    probability
        (h, w) that the person's surface is bare there; off the person, that of their nearest pixel.
    coloured
        (h, w) whether a pixel of the person has the skin's colour rather than another, regardless
        of what is usual for its part.
    learnt_from
        What the skin's colour was learnt from: ``face``, ``hands`` or nothing, for instance if the
        picture has no colours; then head, neck and hands are bare, as is usual, and nothing else.
    by_network
        Whether ``probability`` is what a network sees, not what colours tell.
    """

    probability: GreyImage
    coloured: Mask
    learnt_from: tuple[str, ...]
    by_network: bool = False


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PersonRegions:
    """Places in the picture of the parts of a body near the person.

    Attributes
    ----------
    person
        (h, w) the segmented person.
    parts
        (h, w) index into ``part_names``, -1 off the body.
    part_names
        Of the body model.
    face
        Continuous pixels of the nose or a substitute; None if the face is not seen.
    pixels_per_metre
        At the body's distance.
    """

    person: Mask
    parts: Integer[np.ndarray, "h w"]
    part_names: tuple[str, ...]
    face: Float[np.ndarray, "2"] | None
    pixels_per_metre: float


def skin_map(linear_rgb: Image, regions: PersonRegions) -> SkinMap:
    """Learn the colour of the person's skin, and find where it shows.

    Parameters
    ----------
    linear_rgb
        (h, w, 3) linear light.
    """
    person = regions.person
    coloured = np.zeros_like(person)
    if not person.any():
        nowhere = np.zeros(person.shape, dtype=np.float32)
        return SkinMap(probability=nowhere, coloured=coloured, learnt_from=())
    features = _features(linear_rgb[person])
    parts = nearest_part(regions)[person]
    prior = _bare_shares(regions.part_names)[parts]
    skin, learnt_from = _skin_colours(features, regions, parts)
    if skin is None:
        prior = np.where(prior > _MOSTLY_BARE, prior, _COVERED)
    nats = np.log(prior / (1.0 - prior))
    if skin is not None:
        nats = nats + _skin_over_other(features, skin, prior)
        coloured[person] = _skin_over_other(features, skin, np.full_like(prior, 0.5)) > 0.0
    odds = np.zeros(person.shape, dtype=np.float32)
    odds[person] = np.clip(nats, -_MOST_NATS, _MOST_NATS)
    smooth = _smoothed(odds, person, _SMOOTHING_M * regions.pixels_per_metre)
    everywhere = smooth.ravel()[nearest_of(person)]
    probability = (1.0 / (1.0 + np.exp(-everywhere))).astype(np.float32)
    return SkinMap(probability=probability, coloured=coloured, learnt_from=learnt_from)


def _features(colours: Float[np.ndarray, "s 3"]) -> Features:
    red, green, blue = (np.log(np.maximum(colours, 0.0) + _DARKEST)).T
    brightness = np.log(colours @ np.array([0.2126, 0.7152, 0.0722]) + _DARKEST)
    return (STEPS * np.stack([red - green, blue - green, brightness], axis=1)).astype(np.float32)


def _bare_shares(part_names: tuple[str, ...]) -> Float[np.ndarray, " p"]:
    kinds = [name.removeprefix("left_").removeprefix("right_") for name in part_names]
    return np.array([BARE_SHARE[kind] for kind in kinds])


def nearest_part(regions: PersonRegions) -> Integer[np.ndarray, "h w"]:
    """Each pixel's part; off the body, that of the nearest pixel on it."""
    on_body = regions.parts >= 0
    if not on_body.any():
        return np.zeros_like(regions.parts)
    return regions.parts.ravel()[nearest_of(on_body)]


def nearest_of(region: Mask) -> Integer[np.ndarray, "h w"]:
    """Flat index of each pixel's nearest pixel of a region that is not empty."""
    outside = (~region).astype(np.uint8)
    _, found = cv2.distanceTransformWithLabels(
        outside, cv2.DIST_L2, cv2.DIST_MASK_5, labelType=cv2.DIST_LABEL_PIXEL
    )
    labels = np.asarray(found, dtype=np.int64)
    index = np.zeros(int(labels.max()) + 1, dtype=np.int64)
    index[labels[region]] = np.flatnonzero(region)
    return index[labels]


def _skin_colours(
    features: Features, regions: PersonRegions, parts: Integer[np.ndarray, " s"]
) -> tuple[ColourMixture | None, tuple[str, ...]]:
    """The face is the anchor; hands are used where they look like it.

    In a picture without colours everything looks like the face, so nothing is learnt.
    """
    if not _has_colours(features):
        return None, ()
    rows, columns = np.nonzero(regions.person)
    kinds = np.array([name.rpartition("_")[2] for name in regions.part_names])[parts]
    learnt_from: list[str] = []
    samples = np.empty((0, 3), dtype=np.float32)
    if regions.face is not None:
        away = np.hypot(columns + 0.5 - regions.face[0], rows + 0.5 - regions.face[1])
        radius = FACE_RADIUS_M * regions.pixels_per_metre
        samples = _without_hair(features[(away < radius) & (kinds == "head")])
        if len(samples) >= LEAST_SAMPLES:
            learnt_from.append("face")
        else:
            samples = samples[:0]
    hands = features[kinds == "hand"]
    if learnt_from:
        samples = _unmasked(samples, hands, features[kinds == "neck"])
        hands = hands[_alike(hands, _skin_gaussian(samples))]
    if len(hands) >= LEAST_SAMPLES:
        learnt_from.append("hands")
        # Hands have more pixels than a face, and may hold something: they count at most half.
        step = -(-2 * len(hands) // max(len(samples), 1)) if len(samples) else 1
        samples = np.concatenate([samples, hands[::step]])
    if not learnt_from:
        return None, ()
    return _skin_gaussian(samples), tuple(learnt_from)


def _unmasked(face: SomeFeatures, hands: SomeFeatures, neck: SomeFeatures) -> SomeFeatures:
    """A face's samples; under a mask those of it and of hands or neck that have their colour.

    Skin has the colour that is seen on most of face, hands and neck. Only one that the face shows
    too may take the place of its own: gloves and scarves may be alike.
    """
    places = [each for each in (face, hands, neck) if len(each) >= LEAST_SAMPLES]

    def seen(colour: ColourMixture) -> float:
        return sum(float(np.mean(_alike(each, colour))) for each in places)

    found, least = face, seen(_skin_gaussian(face)) + _CLEARLY_MORE
    for place in places[1:]:
        colour = _skin_gaussian(place)
        shown = _alike(face, colour)
        now = seen(colour)
        if np.mean(shown) >= _IN_SIGHT and now > least:
            # What a mask leaves in sight of a small face is too little to learn from.
            found, least = np.concatenate([face[shown], place[_alike(place, colour)]]), now
    return found


def _alike(features: Features, skin: ColourMixture) -> Bool[np.ndarray, " s"]:
    return _chroma_distance(features, skin) < _UNUSUAL


def _has_colours(features: Features) -> bool:
    """Whether the person shows more than one chroma, unlike in a black-and-white picture."""
    low, high = np.percentile(features[:, :2], [2.0, 98.0], axis=0)
    return bool((high - low).max() > STEPS * _CHROMA_DEVIATION)


def _without_hair(features: Features) -> Float32[np.ndarray, "skin 3"]:
    """The pixels of a face that are not much darker than its brighter half."""
    if not len(features):
        return features
    bright = np.percentile(features[:, 2], 75.0)
    return features[features[:, 2] > bright + STEPS * np.log(_SHADE)]


def _skin_gaussian(samples: Features) -> ColourMixture:
    """A robust Gaussian from the median and what lies near it, plus a wider one for odd skin."""
    chosen = samples.astype(np.float64)
    least = STEPS * np.array([_CHROMA_DEVIATION, _CHROMA_DEVIATION, _BRIGHTNESS_DEVIATION])
    mean, covariance = np.median(chosen, axis=0), np.diag(least**2)
    for _ in range(_ROUNDS):
        away = samples - mean
        near = np.einsum("si,ij,sj->s", away, np.linalg.inv(covariance), away) < 9.0
        if np.count_nonzero(near) < LEAST_SAMPLES // 2:
            break
        chosen = samples[near].astype(np.float64)
        mean = chosen.mean(axis=0)
        # Of the spread only what exceeds the least: shade in one picture is not all there may be.
        spread = np.sqrt(np.maximum(chosen.var(axis=0), least**2))
        covariance = np.diag(spread**2)
    return ColourMixture(
        weights=np.array([1.0 - _WIDE_SHARE, _WIDE_SHARE]),
        means=np.stack([mean, mean]),
        covariances=np.stack([covariance, _WIDE**2 * covariance]),
    )


def _chroma_distance(features: Features, skin: ColourMixture) -> Float[np.ndarray, " s"]:
    """Deviations from the skin's colour regardless of brightness."""
    away = (features - skin.means[0])[:, :2]
    return np.sqrt((away**2 / np.diag(skin.covariances[0])[:2]).sum(axis=1))


def _skin_over_other(
    features: Features, skin: ColourMixture, prior: Float[np.ndarray, " s"]
) -> Float[np.ndarray, " s"]:
    """Log f_skin - log f_other; the other colours are learnt from what is not taken for skin."""
    cost_of_skin = skin.costs(features).astype(np.float64)
    other: Bool[np.ndarray, " s"] = _chroma_distance(features, skin) > _UNUSUAL
    mixture: ColourMixture | None = None
    ratio = np.zeros(len(features))
    for _ in range(_ROUNDS):
        odd = np.full(len(features), _ODD_NATS)
        if np.count_nonzero(other) >= LEAST_SAMPLES:
            known = features[other]
            mixture = first_mixture(known) if mixture is None else relearnt_mixture(mixture, known)
            usual = mixture.costs(features).astype(np.float64) - np.log1p(-_ODD_SHARE)
            odd = -np.logaddexp(-usual, -(odd - np.log(_ODD_SHARE)))
        ratio = odd - cost_of_skin
        other = ratio + np.log(prior / (1.0 - prior)) < 0.0
    return ratio


def _smoothed(values: GreyImage, region: Mask, deviation_px: float) -> GreyImage:
    """Smooth values within a region, ignoring those outside."""
    inside = region.astype(np.float32)
    spread = cv2.GaussianBlur(inside, (0, 0), deviation_px)
    smooth = cv2.GaussianBlur(values * inside, (0, 0), deviation_px)
    return np.where(region, smooth / np.maximum(spread, 1e-6), 0.0).astype(np.float32)


def face_point(
    clicked: Points2D, nose: Float[np.ndarray, "2"] | None
) -> Float[np.ndarray, "2"] | None:
    """Place of the face: the mean of the clicks on it, else the nose of a rendered body."""
    return clicked.mean(axis=0) if len(clicked) else nose
