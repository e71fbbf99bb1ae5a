"""The few EXIF fields the fit can use."""

import math
from dataclasses import dataclass
from enum import IntEnum

from PIL import Image as PillowImage


class _Tag(IntEnum):
    ORIENTATION = 0x0112
    EXIF_DIRECTORY = 0x8769
    FOCAL_LENGTH = 0x920A
    PIXEL_X_DIMENSION = 0xA002
    FOCAL_PLANE_X_RESOLUTION = 0xA20E
    FOCAL_PLANE_RESOLUTION_UNIT = 0xA210
    FOCAL_LENGTH_IN_35MM_FILM = 0xA405


MILLIMETRES_PER_UNIT = {2: 25.4, 3: 10.0, 4: 1.0, 5: 0.001}
"""FocalPlaneResolutionUnit: inch and centimetre by the standard; millimetre and micrometre are
written by some cameras."""

DEFAULT_RESOLUTION_UNIT = 2


@dataclass(frozen=True, slots=True, kw_only=True)
class ExifTags:
    """EXIF values that are present and make sense; None otherwise.

    Attributes
    ----------
    orientation
        1 to 8; 1 (upright) where absent or out of range.
    focal_length_35mm
        FocalLengthIn35mmFilm, millimetres.
    focal_length_mm
        FocalLength, millimetres.
    sensor_pixels_per_mm
        FocalPlaneXResolution, at the size the camera stored the picture in.
    pixel_x_dimension
        The width the camera stored the picture in.
    """

    orientation: int = 1
    focal_length_35mm: float | None = None
    focal_length_mm: float | None = None
    sensor_pixels_per_mm: float | None = None
    pixel_x_dimension: float | None = None


def read_exif(picture: PillowImage.Image) -> ExifTags:
    """Read the tags; a damaged EXIF block counts as none, as it does in browsers."""
    # The block is the caller's bytes: parsers may raise almost anything. The orientation may be
    # intact even if the rest is not.
    try:
        exif = picture.getexif()
        orientation = exif.get(_Tag.ORIENTATION, 1)
    except Exception:
        return ExifTags()
    try:
        directory = exif.get_ifd(_Tag.EXIF_DIRECTORY)
    except Exception:
        directory = {}
    unit = directory.get(_Tag.FOCAL_PLANE_RESOLUTION_UNIT, DEFAULT_RESOLUTION_UNIT)
    resolution = _positive(directory.get(_Tag.FOCAL_PLANE_X_RESOLUTION))
    millimetres = MILLIMETRES_PER_UNIT.get(unit) if isinstance(unit, int) else None
    return ExifTags(
        orientation=orientation if orientation in range(1, 9) else 1,
        focal_length_35mm=_positive(directory.get(_Tag.FOCAL_LENGTH_IN_35MM_FILM)),
        focal_length_mm=_positive(directory.get(_Tag.FOCAL_LENGTH)),
        sensor_pixels_per_mm=resolution / millimetres if resolution and millimetres else None,
        pixel_x_dimension=_positive(directory.get(_Tag.PIXEL_X_DIMENSION)),
    )


def _positive(value: object) -> float | None:
    """The value as a positive finite number; cameras write 0 or 0/0 for "unknown"."""
    try:
        number = float(value)  # pyright: ignore[reportArgumentType]
    except (TypeError, ValueError, ZeroDivisionError):
        return None
    return number if math.isfinite(number) and number > 0.0 else None
