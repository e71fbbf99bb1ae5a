"""A picture's header: kind, upright size, animation and focal length, by Pillow.

Pillow opens a picture without decoding its pixels, but inflates the texts of a PNG and calls
libraries for WebP and HEIC: the API has it done in a child (:mod:`service.compute.lanes`).
"""

import contextlib
import io
import re
import warnings
from collections.abc import Callable
from typing import Final

from api_schemas.base import WireModel
from fitter.observation.picture_files import FORMAT, decodes_heif, is_heif, ready_decoder

HEIC: Final = "image/heic"
KINDS: Final = {"JPEG": "image/jpeg", "PNG": "image/png", "WEBP": "image/webp", FORMAT: HEIC}
"""Media types by Pillow's names."""

TURNED: Final = range(5, 9)
"""Orientations that swap width and height."""


MARKER: Final = re.compile(rb"\xff+([^\x00\xd0-\xd7\xff])")
"""Code of a JPEG's next marker; what stands among coded pixels is none."""
FIRST_MARKER, END_OF_PICTURE, SCAN = 0xC0, 0xD9, 0xDA


class ImageHeader(WireModel):
    """Kind and upright size (EXIF orientation applied) of a picture.

    ``focal_length_35mm`` is the equivalent in its EXIF data, None if there is none. ``scans`` says
    how often a decoder goes over all pixels, as it does for a progressive JPEG.
    """

    media_type: str
    width: int
    height: int
    animated: bool = False
    focal_length_35mm: float | None = None
    scans: int = 1


class UnknownImageError(Exception):
    """The bytes are not a JPEG, PNG, WebP or HEIC."""


class DamagedImageError(Exception):
    """The bytes begin as a picture should, but the header is cut off or contradicts itself."""


class UndecodedHeicError(Exception):
    """The bytes are a HEIC, whose decoder is not installed here."""


ReadHeader = Callable[[bytes], ImageHeader]
"""Raises UnknownImageError, DamagedImageError or UndecodedHeicError."""


def read_image_header(content: bytes) -> ImageHeader:
    """Read the header of a JPEG, PNG, WebP or HEIC; raises as :data:`ReadHeader` says."""
    kind = kind_of(content)
    # Imported here: the API knows of headers and loads no decoder.
    from PIL import Image

    from fitter.observation.picture_files import ExifTags, read_exif

    if kind == FORMAT:
        ready_decoder("image")
    with warnings.catch_warnings(), contextlib.ExitStack() as stack:
        warnings.simplefilter("ignore")
        # The size is judged by the caller: nothing is decoded here, however large it is.
        stack.callback(setattr, Image, "MAX_IMAGE_PIXELS", Image.MAX_IMAGE_PIXELS)
        Image.MAX_IMAGE_PIXELS = None
        try:
            picture = Image.open(io.BytesIO(content), formats=(kind,))
        except MemoryError:
            raise
        except Exception as error:
            # Of hostile bytes parsers may raise almost anything.
            message = "the header is cut off or contradicts itself"
            raise DamagedImageError(message) from error
        # A PNG that has none before its pixels would be decoded to look for it behind them.
        has_exif = kind != "PNG" or "exif" in picture.info
        exif = read_exif(picture) if has_exif else ExifTags()
    width, height = picture.size
    if exif.orientation in TURNED:
        width, height = height, width
    return ImageHeader(
        media_type=KINDS[kind],
        width=width,
        height=height,
        animated=kind in ("PNG", "WEBP") and bool(getattr(picture, "is_animated", False)),
        focal_length_35mm=exif.focal_length_35mm,
        scans=_scans(content) if kind == "JPEG" else 1,
    )


def _scans(content: bytes) -> int:
    """Number of a JPEG's scans, found as a decoder finds them, from marker to marker."""
    at, scans = 2, 0
    while (found := MARKER.search(content, at)) is not None:
        code, at = found[1][0], found.end()
        if code == END_OF_PICTURE:
            break
        scans += code == SCAN
        if code >= FIRST_MARKER:
            at += int.from_bytes(content[at : at + 2])
    return scans


def kind_of(content: bytes) -> str:
    """Pillow's name of the kind, told by the first bytes.

    Raises
    ------
    UnknownImageError
        If it is none of those that are read.
    UndecodedHeicError
        If it is a HEIC and nothing reads one.
    """
    if content.startswith(b"\xff\xd8\xff"):
        return "JPEG"
    if content.startswith(b"\x89PNG\r\n\x1a\n"):
        return "PNG"
    if content[:4] == b"RIFF" and content[8:12] == b"WEBP":
        return "WEBP"
    if is_heif(content):
        if not decodes_heif():
            raise UndecodedHeicError
        return FORMAT
    raise UnknownImageError
