"""Rendered pictures of the evaluation suite with tri-maps round their bodies, moved."""

import io
from dataclasses import dataclass

import numpy as np
from PIL import Image as PillowImage

from fitter.segmentation.trimap import first_band, trimap
from tests.accuracy.cases import CASES
from tests.accuracy.files import read_case

PICTURES = tuple(CASES)[:3]
"""The packaged sample and the first two of the suite."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RenderedPicture:
    """8-bit display values (h, w, 3), the tri-map, and the person's true mask."""

    pixels: np.ndarray
    labels: np.ndarray
    person: np.ndarray


def rendered_picture(name: str) -> RenderedPicture:
    files = read_case(CASES[name])
    with PillowImage.open(io.BytesIO(files.image)) as opened:
        pixels = np.asarray(opened.convert("RGB"))
    guess = np.roll(files.body_mask, (5, -6), axis=(0, 1))
    no_bones = np.zeros((0, 2, 2))
    labels = trimap(guess, no_bones, band=first_band(guess, no_bones))
    return RenderedPicture(pixels=pixels, labels=labels, person=files.person_mask)
