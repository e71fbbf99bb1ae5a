"""Files of pictures, read without numerics: the few EXIF fields a fit can use, and HEIC.

The decoder of HEIC, which phones take, is libheif with libde265, in the package pi-heif, which only
decodes. It turns the picture as the container says, and rewrites EXIF's orientation to upright, so
that nothing is turned twice. Of ten bits it keeps the upper eight; of several pictures it opens the
primary one.
"""

import importlib.util
import math
from dataclasses import dataclass
from enum import IntEnum
from functools import cache
from typing import Final

from PIL import Image as PillowImage

from fitter.errors import InvalidInputError

PACKAGE: Final = "pi_heif"
FORMAT: Final = "HEIF"
"""Its name in Pillow."""

WHOLE_PIXELS: Final = 51_000_000
"""Most pixels that are decoded, some 150 MB: 50-megapixel phones take 50.3 million. A larger JPEG
is decoded at a half, a quarter or an eighth of its size."""

NOT_INSTALLED_CODE: Final = "heic-not-installed"
NOT_INSTALLED: Final = "HEIC pictures are not decoded here: the package pi-heif is not installed."
REMEDY: Final = (
    "Send a JPEG, or have the extra `heic` installed in this service: pip install 'maquette[heic]'."
)

BRANDS: Final = frozenset({b"heic", b"heix", b"heim", b"heis"})
"""Pictures coded with HEVC."""

MOST_BRANDS: Final = 100

ORIENTATION: Final = "original_orientation"
"""Key of the EXIF orientation as it was before the decoder rewrote it."""


def is_heif(data: bytes) -> bool:
    """Whether a file says that it holds pictures coded with HEVC."""
    if data[4:8] != b"ftyp":
        return False
    end = min(int.from_bytes(data[:4]), 16 + 4 * MOST_BRANDS)
    return not BRANDS.isdisjoint({data[8:12], *(data[at : at + 4] for at in range(16, end, 4))})


def decodes_heif() -> bool:
    """Whether the decoder is installed; it is not loaded."""
    return importlib.util.find_spec(PACKAGE) is not None


def ready_decoder(field: str) -> None:
    """Load the decoder and let Pillow know of it.

    Raises
    ------
    InvalidInputError
        ``heic-not-installed``, if there is none.
    """
    if not decodes_heif():
        raise InvalidInputError(
            code=NOT_INSTALLED_CODE, field=field, reason=NOT_INSTALLED, remedy=REMEDY
        )
    _register()


@cache
def _register() -> None:
    import pi_heif

    # Thumbnails and depth maps are not looked at. Jobs run side by side, a processor core each.
    pi_heif.register_heif_opener(
        thumbnails=False, depth_images=False, aux_images=False, decode_threads=1
    )


class _Tag(IntEnum):
    ORIENTATION = 0x0112
    EXIF_DIRECTORY = 0x8769
    FOCAL_LENGTH = 0x920A
    PIXEL_X_DIMENSION = 0xA002
    PIXEL_Y_DIMENSION = 0xA003
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
    pixel_x_dimension, pixel_y_dimension
        The size the camera stored the picture in.
    """

    orientation: int = 1
    focal_length_35mm: float | None = None
    focal_length_mm: float | None = None
    sensor_pixels_per_mm: float | None = None
    pixel_x_dimension: float | None = None
    pixel_y_dimension: float | None = None


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
        pixel_y_dimension=_positive(directory.get(_Tag.PIXEL_Y_DIMENSION)),
    )


def _positive(value: object) -> float | None:
    """The value as a positive finite number; cameras write 0 or 0/0 for "unknown"."""
    try:
        number = float(value)  # pyright: ignore[reportArgumentType]
    except (TypeError, ValueError, ZeroDivisionError):
        return None
    return number if math.isfinite(number) and number > 0.0 else None
