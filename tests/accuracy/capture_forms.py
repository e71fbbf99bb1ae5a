"""Pictures spoilt in one way each, with what the checks of a capture are to find in them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import cv2
import numpy as np
from jaxtyping import UInt8

from fitter.arrays import Mask
from fitter.fits.capture_check import CaptureQuestion
from fitter.observation.pixels import WORKING_PIXELS, display_from_linear, linear_from_display
from fitter.vocabulary.remarks import Code

Picture = UInt8[np.ndarray, "h w 3"]

Spoil = Callable[["Source"], Picture]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Source:
    """A picture, its person's true mask and what is asked of it as it is."""

    picture: Picture
    mask: Mask
    question: CaptureQuestion


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Form:
    """A picture, what is asked of it, and which findings are right or wrong.

    ``truth`` says of a code whether it is to be found; of the others nothing is known.
    """

    name: str
    picture: Picture
    question: CaptureQuestion
    truth: Mapping[Code, bool]


def spoilt_forms(source: Source, other: Picture) -> list[Form]:
    """The picture spoilt in each way; ``other`` is the picture of somebody else."""
    made = [
        Form(
            name=name,
            picture=spoil(source),
            question=_without_lens(source.question),
            truth={code: wrong},
        )
        for name, (spoil, code, wrong) in _SPOILT.items()
    ]
    return [
        *made,
        Form(
            name="beside another",
            picture=beside(source.picture, other),
            question=_without_lens(source.question),
            truth={Code.SEVERAL_PEOPLE: True},
        ),
    ]


def blurred(source: Source, *, deviation_px: float) -> Picture:
    """Blurred by so many pixels of the working picture."""
    return cv2.GaussianBlur(source.picture, (0, 0), deviation_px * _per_working_pixel(source))


def shaken(source: Source, *, length_px: int, sideways: bool) -> Picture:
    """Smeared sideways, or up and down, over so many pixels of the working picture."""
    length = max(3, round(length_px * _per_working_pixel(source)))
    shape = (1, length) if sideways else (length, 1)
    return cv2.filter2D(source.picture, -1, np.full(shape, 1.0 / length, np.float32))


def exposed(source: Source, *, factor: float) -> Picture:
    """With so much of the light; less light has the noise of a short exposure."""
    light = factor * linear_from_display(source.picture / 255.0)
    rng = np.random.default_rng(source.picture.size)
    noise = rng.normal(0.0, 1.0, light.shape) * np.sqrt(1e-4 * light + 5e-8)
    return np.rint(255.0 * display_from_linear(np.clip(light + noise, 0.0, 1.0))).astype(np.uint8)


ROLLED_SCALE = 0.85
"""A rolled picture is reduced so far that the person stays in it."""


def rolled(source: Source, *, degrees: float) -> Picture:
    """As by a camera that was rolled; the border is repeated outward."""
    height, width = source.picture.shape[:2]
    turn = cv2.getRotationMatrix2D((width / 2, height / 2), degrees, ROLLED_SCALE)
    return cv2.warpAffine(
        source.picture, turn, (width, height), flags=cv2.INTER_AREA, borderMode=cv2.BORDER_REPLICATE
    )


def cropped(source: Source, *, top: float = 0.0, bottom: float = 1.0) -> Picture:
    """Between two shares of the person's height, from the top."""
    rows = np.flatnonzero(source.mask.any(axis=1))
    tall = len(rows)
    first = rows[0] + round(top * tall) if top > 0.0 else 0
    last = rows[0] + round(bottom * tall) if bottom < 1.0 else len(source.picture)
    return np.ascontiguousarray(source.picture[first:last])


def cropped_aside(source: Source) -> Picture:
    """Without the left sixth of the person."""
    columns = np.flatnonzero(source.mask.any(axis=0))
    first = columns[0] + (columns[-1] - columns[0]) // 6
    return np.ascontiguousarray(source.picture[:, first:])


def reduced(source: Source, *, stature_px: float) -> Picture:
    """So small that the person has this many pixels."""
    return _scaled(source.picture, stature_px / _tall(source))


def far_away(source: Source, *, stature_px: float) -> Picture:
    """As small as :func:`reduced`, in a picture of the working size, before a wall."""
    small = reduced(source, stature_px=stature_px)
    side = round(WORKING_PIXELS**0.5)
    rows, columns = side - len(small), side - small.shape[1]
    return np.pad(
        small,
        ((rows // 2, rows - rows // 2), (columns // 2, columns - columns // 2), (0, 0)),
        mode="edge",
    )


def beside(picture: Picture, other: Picture) -> Picture:
    """Two pictures side by side, of the first one's height."""
    return np.concatenate([picture, _fitted(other, len(picture))], axis=1)


_SPOILT: Mapping[str, tuple[Spoil, Code, bool]] = {
    "blurred by 1 px": (lambda it: blurred(it, deviation_px=1.0), Code.BLURRED, False),
    "blurred by 2 px": (lambda it: blurred(it, deviation_px=2.0), Code.BLURRED, True),
    "blurred by 4 px": (lambda it: blurred(it, deviation_px=4.0), Code.BLURRED, True),
    "shaken sideways by 11 px": (
        lambda it: shaken(it, length_px=11, sideways=True), Code.BLURRED, True,
    ),
    "shaken up and down by 11 px": (
        lambda it: shaken(it, length_px=11, sideways=False), Code.BLURRED, True,
    ),
    "a quarter of the light": (lambda it: exposed(it, factor=0.25), Code.TOO_DARK, False),
    "a fortieth of the light": (lambda it: exposed(it, factor=0.025), Code.TOO_DARK, True),
    "a half more light": (lambda it: exposed(it, factor=1.5), Code.TOO_BRIGHT, False),
    "five times the light": (lambda it: exposed(it, factor=5.0), Code.TOO_BRIGHT, True),
    "rolled by 3 degrees": (lambda it: rolled(it, degrees=3.0), Code.CAMERA_ROLLED, False),
    "rolled by 15 degrees": (lambda it: rolled(it, degrees=15.0), Code.CAMERA_ROLLED, True),
    "without the head": (lambda it: cropped(it, top=0.08), Code.CUT_OFF, True),
    "without the shins": (lambda it: cropped(it, bottom=0.75), Code.CUT_OFF, True),
    "without the feet": (lambda it: cropped(it, bottom=0.96), Code.CUT_OFF, True),
    "without an arm": (cropped_aside, Code.CUT_OFF, True),
    "reduced to 140 px": (lambda it: reduced(it, stature_px=140.0), Code.PICTURE_TOO_SMALL, True),
    "200 px far away": (lambda it: far_away(it, stature_px=200.0), Code.PERSON_TOO_SMALL, True),
    "330 px far away": (lambda it: far_away(it, stature_px=330.0), Code.PERSON_TOO_SMALL, False),
}  # fmt: skip
"""How a picture is spoilt, the code that tells it, and whether it is to be told."""


def _without_lens(question: CaptureQuestion) -> CaptureQuestion:
    return replace(question, focal_length_px=None, focal_length_35mm=None)


def _per_working_pixel(source: Source) -> float:
    height, width = source.picture.shape[:2]
    return max(1.0, (height * width / WORKING_PIXELS) ** 0.5)


def _tall(source: Source) -> int:
    rows = np.flatnonzero(source.mask.any(axis=1))
    return int(rows[-1] - rows[0] + 1)


def _scaled(picture: Picture, factor: float) -> Picture:
    return cv2.resize(picture, None, fx=factor, fy=factor, interpolation=cv2.INTER_AREA)


def _fitted(picture: Picture, height: int) -> Picture:
    return _scaled(picture, height / len(picture))[:height]
