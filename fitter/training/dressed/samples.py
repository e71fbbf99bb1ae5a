"""Pixels of drawn people, sampled, each with its label and what the perceptron reads there."""

from concurrent.futures import ProcessPoolExecutor
from functools import cache, partial
from multiprocessing import get_context
from typing import Final, NamedTuple

import cv2
import numpy as np
from jaxtyping import Float16, Float32, Integer, UInt8

from fitter.detection.network import ActivationNetwork
from fitter.detection.weights import checked_weights
from fitter.detection.worn_parts import WornPart, hypercolumns
from fitter.training.dressed.cloths import cloth_colour_near_skin
from fitter.training.dressed.pictures import SIZE, DressedPicture, dressed_picture

PIXELS: Final = 420
"""Sampled of a picture."""

PERSON_SHARE, BESIDE_SHARE = 0.62, 0.22
"""Of the pixels: on the person, as many of each part, and beside the outline; others anywhere."""

BESIDE_PX: Final = 5
LOOKS: Final = 2
"""How often a picture is seen, each time moved, turned and toned anew, and but for the first in
other colours."""

RECOLOURED: Final = 0.5
LEAST_PIXELS: Final = 30
"""Share of cloths that get another colour, if they are seen in so many pixels."""


class Samples(NamedTuple):
    """What is read at pixels, (k, 639), their labels, (k,), and how many pixels each stands for.

    Of the background it is as many as beside a person, where it matters.
    """

    read: Float16[np.ndarray, "k r"]
    labels: Integer[np.ndarray, " k"]
    stands_for: Float32[np.ndarray, " k"]


def samples(seeds: range, processes: int) -> Samples:
    """Samples of the pictures of some numbers, in their order."""
    if processes == 1:
        found = [samples_of_picture(seed) for seed in seeds]
    else:
        with ProcessPoolExecutor(processes, mp_context=get_context("spawn")) as pool:
            found = list(pool.map(samples_of_picture, seeds, chunksize=8))
    return joined(found)


def joined(found: list[Samples]) -> Samples:
    """Samples of several pictures."""
    return Samples(*(np.concatenate(each) for each in zip(*found, strict=True)))


def samples_of_picture(seed: int) -> Samples:
    """Samples of one picture, seen some times."""
    rng = np.random.default_rng([seed, 1])
    drawn = dressed_picture(seed)
    looks = [drawn, *(recoloured(drawn, rng) for _ in range(1, LOOKS))]
    return joined([_samples_of_look(changed(look, rng), rng) for look in looks])


def recoloured(drawn: DressedPicture, rng: np.random.Generator) -> DressedPicture:
    """The picture with most cloths in other colours, skin's and warm ones above all.

    Upper and lower cloth are told apart by the crop's middle, about where hips are.
    """
    light, labels = (drawn.picture / 255.0) ** 2.2, drawn.labels
    above = np.arange(SIZE)[:, None] < SIZE / 2 + rng.normal(0.0, 6.0)
    cloths = [labels == WornPart.OUTER, (labels == WornPart.CLOTH) & above]
    for there in (*cloths, (labels == WornPart.CLOTH) & ~above):
        if there.sum() < LEAST_PIXELS or rng.random() > RECOLOURED:
            continue
        grey = light[there].mean(axis=1)
        folds = np.clip(grey / max(float(grey.mean()), 0.01), 0.0, 3.0)
        light[there] = cloth_colour_near_skin(rng) * rng.uniform(0.6, 1.1) * folds[:, None]
    shown = np.clip(light, 0.0, 1.0) ** (1.0 / 2.2)
    return DressedPicture((255.0 * shown).astype(np.uint8), labels)


def changed(drawn: DressedPicture, rng: np.random.Generator) -> DressedPicture:
    """The picture mirrored or not, moved, turned, enlarged and toned a little."""
    picture, labels = drawn
    if rng.random() < 0.5:
        picture, labels = picture[:, ::-1], labels[:, ::-1]
    middle, larger = (SIZE / 2, SIZE / 2), float(np.exp(rng.normal(0.0, 0.06)))
    moved = cv2.getRotationMatrix2D(middle, rng.normal(0.0, 4.0), larger)
    moved[:, 2] += rng.normal(0.0, 6.0, 2)
    warp = partial(cv2.warpAffine, M=moved, dsize=(SIZE, SIZE))
    picture = warp(np.ascontiguousarray(picture), borderMode=cv2.BORDER_REFLECT)
    labels = warp(np.ascontiguousarray(labels), flags=cv2.INTER_NEAREST)
    toned = (picture / 255.0) ** np.exp(rng.normal(0.0, 0.2))
    toned = toned * np.exp(rng.normal(0.0, 0.1) + rng.normal(0.0, 0.06, 3))
    return DressedPicture((255.0 * np.clip(toned, 0.0, 1.0)).astype(np.uint8), labels)


def _samples_of_look(look: DressedPicture, rng: np.random.Generator) -> Samples:
    chosen, stands_for = chosen_pixels(look.labels, rng)
    rows, columns = np.divmod(chosen, SIZE)
    read = hypercolumns(_network(), look.picture).at(rows // 2, columns // 2)
    labels = look.labels[rows, columns].astype(np.int64)
    return Samples(read.astype(np.float16), labels, stands_for)


def chosen_pixels(
    labels: UInt8[np.ndarray, "s s"], rng: np.random.Generator
) -> tuple[Integer[np.ndarray, " k"], Float32[np.ndarray, " k"]]:
    """Flat indices: of each part that is there, of what lies beside the person, of the rest.

    And how many pixels each of them stands for.
    """
    flat = labels.ravel()
    parts = [np.flatnonzero(flat == part) for part in WornPart if part is not WornPart.BACKGROUND]
    parts = [each for each in parts if len(each)]
    reach = np.ones((2 * BESIDE_PX + 1,) * 2)
    grown = cv2.dilate((labels > 0).astype(np.uint8), reach).ravel() > 0
    beside = np.flatnonzero(grown & (flat == 0))
    wanted = [(each, int(PIXELS * PERSON_SHARE / max(len(parts), 1))) for each in parts]
    wanted.append((beside, int(PIXELS * BESIDE_SHARE)))
    chosen = [rng.choice(each, min(count, len(each)), replace=False) for each, count in wanted]
    stands_for = [
        np.full(len(some), len(each) / len(some), np.float32)
        for some, (each, _) in zip(chosen, wanted, strict=True)
    ]
    rest = int(PIXELS * (1.0 - PERSON_SHARE - BESIDE_SHARE))
    chosen.append(rng.choice(np.flatnonzero(flat == 0), rest))
    stands_for.append(np.full(rest, stands_for[-1][0], np.float32))
    return np.concatenate(chosen), np.concatenate(stands_for)


@cache
def _network() -> ActivationNetwork:
    return ActivationNetwork(checked_weights().body_landmarks)
