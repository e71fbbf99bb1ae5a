"""The two EXIF facts the API needs, read without a decoder: orientation and focal length.

The block is the caller's bytes. Whatever cannot be followed counts as absent, as it does in
browsers; nothing is read outside the block.

Sources: TIFF 6.0 section 2; Exif 2.32 tags 0x0112 (Orientation), 0x8769 (Exif IFD pointer) and
0xA405 (FocalLengthIn35mmFilm).
"""

import struct
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

ORIENTATION: Final = 0x0112
EXIF_DIRECTORY: Final = 0x8769
FOCAL_LENGTH_IN_35MM_FILM: Final = 0xA405

SHORT: Final = 3
LONG: Final = 4

MAX_ENTRIES: Final = 1_000
"""No camera writes a tenth as many into a directory; a made-up one would keep the reader busy."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ExifFacts:
    """Orientation 1 (upright) to 8, and the 35 mm equivalent in millimetres if it is named."""

    orientation: int = 1
    focal_length_35mm: float | None = None


def read_exif_facts(tiff: bytes) -> ExifFacts:
    """Read a TIFF block; what is absent or damaged has its default."""
    order = {b"II": "<", b"MM": ">"}.get(tiff[:2])
    if order is None:
        return ExifFacts()
    try:
        (offset,) = struct.unpack_from(f"{order}I", tiff, 4)
    except struct.error:
        return ExifFacts()
    first = _directory(tiff, order, offset)
    exif = _directory(tiff, order, first[EXIF_DIRECTORY]) if EXIF_DIRECTORY in first else {}
    orientation = first.get(ORIENTATION, 1)
    focal_length = exif.get(FOCAL_LENGTH_IN_35MM_FILM, 0)
    return ExifFacts(
        orientation=orientation if 1 <= orientation <= 8 else 1,
        focal_length_35mm=float(focal_length) if focal_length > 0 else None,
    )


def _directory(tiff: bytes, order: str, offset: int) -> Mapping[int, int]:
    """Single SHORT and LONG values by tag, as far as the directory can and need be followed."""
    values: dict[int, int] = {}
    try:
        (count,) = struct.unpack_from(f"{order}H", tiff, offset)
        for entry in range(min(count, MAX_ENTRIES)):
            position = offset + 2 + 12 * entry
            tag, kind = struct.unpack_from(f"{order}HH", tiff, position)
            if kind == SHORT:
                (values[tag],) = struct.unpack_from(f"{order}H", tiff, position + 8)
            elif kind == LONG:
                (values[tag],) = struct.unpack_from(f"{order}I", tiff, position + 8)
    except struct.error:
        return values
    return values
