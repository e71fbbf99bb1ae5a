"""A picture spoilt: blurred, in another light, rolled, cropped, reduced, beside another."""

import cv2
import numpy as np
from jaxtyping import UInt8

from fitter.arrays import Mask
from fitter.observation.pixels import WORKING_PIXELS, display_from_linear, linear_from_display

Picture = UInt8[np.ndarray, "h w 3"]

ROLLED_SCALE = 0.85
"""A rolled picture is reduced so far that the person stays in it."""


def blurred(picture: Picture, *, deviation_px: float) -> Picture:
    """Blurred by so many pixels of the working picture."""
    height, width = picture.shape[:2]
    scale = max(1.0, (height * width / WORKING_PIXELS) ** 0.5)
    return cv2.GaussianBlur(picture, (0, 0), deviation_px * scale)


def exposed(picture: Picture, *, factor: float) -> Picture:
    """With so much of the light; less light has the noise of a short exposure."""
    light = factor * linear_from_display(picture / 255.0)
    rng = np.random.default_rng(picture.size)
    noise = rng.normal(0.0, 1.0, light.shape) * np.sqrt(1e-4 * light + 5e-8)
    return np.rint(255.0 * display_from_linear(np.clip(light + noise, 0.0, 1.0))).astype(np.uint8)


def rolled(picture: Picture, *, degrees: float) -> Picture:
    """As by a camera that was rolled; the border is repeated outward."""
    height, width = picture.shape[:2]
    turn = cv2.getRotationMatrix2D((width / 2, height / 2), degrees, ROLLED_SCALE)
    return cv2.warpAffine(
        picture, turn, (width, height), flags=cv2.INTER_AREA, borderMode=cv2.BORDER_REPLICATE
    )


def cropped(picture: Picture, person: Mask, *, bottom: float) -> Picture:
    """Down to a share of the person's height, from the top."""
    rows = np.flatnonzero(person.any(axis=1))
    return np.ascontiguousarray(picture[: rows[0] + round(bottom * len(rows))])


def reduced(picture: Picture, person: Mask, *, stature_px: float) -> Picture:
    """So small that the person has this many pixels."""
    rows = np.flatnonzero(person.any(axis=1))
    return _scaled(picture, stature_px / int(rows[-1] - rows[0] + 1))


def far_away(picture: Picture, person: Mask, *, stature_px: float) -> Picture:
    """As small as :func:`reduced`, in a picture of the working size, before a wall."""
    small = reduced(picture, person, stature_px=stature_px)
    side = round(WORKING_PIXELS**0.5)
    rows, columns = side - len(small), side - small.shape[1]
    return np.pad(
        small,
        ((rows // 2, rows - rows // 2), (columns // 2, columns - columns // 2), (0, 0)),
        mode="edge",
    )


def beside(picture: Picture, other: Picture) -> Picture:
    """Two pictures side by side, of the first one's height."""
    height = len(picture)
    return np.concatenate([picture, _scaled(other, height / len(other))[:height]], axis=1)


def _scaled(picture: Picture, factor: float) -> Picture:
    return cv2.resize(picture, None, fx=factor, fy=factor, interpolation=cv2.INTER_AREA)
