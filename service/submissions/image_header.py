"""What a picture's header says, read without decoding a pixel.

Of several EXIF blocks, which no container allows, one is read: the one that decoders take, the last
of a PNG and the first of others.

The API looks only this far: kind by magic bytes, size, EXIF orientation and focal length,
animation. Decoders meet the caller's bytes in the child process alone, so this reads the three
containers by itself, and ``heif_header`` the fourth. Pillow's ``Image.open`` inflates the texts of
a PNG: one of 61 kB then takes 1.6 s and 58 MB, in which the API answers nobody; here it is 0.02 ms.
For WebP and HEIC it calls libraries in C and C++, beside the database's password.

Sources: ITU-T T.81 annex B (JPEG markers), the PNG specification section 11, the WebP container
specification.
"""

import struct
from collections.abc import Iterator
from dataclasses import dataclass

from fitter.observation.heif import is_heif
from service.submissions.exif_header import ExifFacts, read_exif_facts
from service.submissions.heif_header import HeifFaultError, read_heif_facts

TURNED = range(5, 9)
"""Orientations that swap width and height."""

MAX_SEGMENTS = 20_000
"""No real picture has more segments or chunks; a made-up one would keep the reader busy."""

JPEG_FRAME_MARKERS = frozenset(range(0xC0, 0xD0)) - {0xC4, 0xC8, 0xCC}
JPEG_BARE_MARKERS = frozenset({0x01, *range(0xD0, 0xD9)})
JPEG_SCAN = 0xDA
JPEG_END = 0xD9
JPEG_APP1 = 0xE1
EXIF_MARK = b"Exif\0\0"
PNG_START = 8
HEIC = "image/heic"


@dataclass(frozen=True, slots=True, kw_only=True)
class ImageHeader:
    """Kind and upright size (EXIF orientation applied) of a picture.

    ``focal_length_35mm`` is the equivalent in its EXIF data, None if there is none.
    """

    media_type: str
    width: int
    height: int
    animated: bool
    focal_length_35mm: float | None


class UnknownImageError(Exception):
    """The bytes are not a JPEG, PNG, WebP or HEIC."""


class DamagedImageError(Exception):
    """The bytes begin as a picture should, but the header is cut off or contradicts itself."""


def read_image_header(content: bytes) -> ImageHeader:
    """Read the header of a JPEG, PNG, WebP or HEIC.

    Raises
    ------
    UnknownImageError
        If it is none of these.
    DamagedImageError
        If the header cannot be followed to the size.
    """
    try:
        if content.startswith(b"\xff\xd8\xff"):
            return _jpeg(content)
        if content.startswith(b"\x89PNG\r\n\x1a\n"):
            return _png(content)
        if content[:4] == b"RIFF" and content[8:12] == b"WEBP":
            return _webp(content)
        if is_heif(content):
            return _heif(content)
    except HeifFaultError as error:
        raise DamagedImageError(str(error)) from error
    except (struct.error, IndexError) as error:
        message = "the header ends too early"
        raise DamagedImageError(message) from error
    raise UnknownImageError


def _header(
    media_type: str, width: int, height: int, *, exif: ExifFacts, animated: bool
) -> ImageHeader:
    if width < 1 or height < 1:
        message = "the header gives a size of zero"
        raise DamagedImageError(message)
    if exif.orientation in TURNED:
        width, height = height, width
    return ImageHeader(
        media_type=media_type,
        width=width,
        height=height,
        animated=animated,
        focal_length_35mm=exif.focal_length_35mm,
    )


def _jpeg(content: bytes) -> ImageHeader:
    exif = b""
    position = 2
    for _ in range(MAX_SEGMENTS):
        if content[position] != 0xFF:
            message = "a marker is missing"
            raise DamagedImageError(message)
        marker = content[position + 1]
        if marker == 0xFF:  # a fill byte
            position += 1
            continue
        if marker in JPEG_BARE_MARKERS:
            position += 2
            continue
        if marker in (JPEG_SCAN, JPEG_END):
            message = "the picture data begin before the size is given"
            raise DamagedImageError(message)
        (length,) = struct.unpack_from(">H", content, position + 2)
        if marker in JPEG_FRAME_MARKERS:
            height, width = struct.unpack_from(">HH", content, position + 5)
            facts = read_exif_facts(exif)
            return _header("image/jpeg", width, height, exif=facts, animated=False)
        if marker == JPEG_APP1 and content[position + 4 : position + 10] == EXIF_MARK:
            exif = exif or content[position + 10 : position + 2 + length]
        position += 2 + length
    message = "it has no end of segments"
    raise DamagedImageError(message)


def _png(content: bytes) -> ImageHeader:
    if content[12:16] != b"IHDR":
        message = "the header chunk is missing"
        raise DamagedImageError(message)
    width, height = struct.unpack_from(">II", content, 16)
    exif = b""
    animated = False
    position = PNG_START
    for _ in range(MAX_SEGMENTS):
        if position + 8 > len(content):
            break
        (length,) = struct.unpack_from(">I", content, position)
        kind = content[position + 4 : position + 8]
        if kind == b"acTL":
            animated = True
        elif kind == b"eXIf":
            exif = content[position + 8 : position + 8 + length]
        elif kind == b"IHDR" and position > PNG_START:
            message = "it has two header chunks"
            raise DamagedImageError(message)
        position += 12 + length
    return _header("image/png", width, height, exif=read_exif_facts(exif), animated=animated)


def _webp(content: bytes) -> ImageHeader:
    kind = content[12:16]
    if kind == b"VP8 ":
        width, height = struct.unpack_from("<HH", content, 26)
        # The two upper bits are a scale for display that decoders ignore.
        return _header(
            "image/webp", width & 0x3FFF, height & 0x3FFF, exif=ExifFacts(), animated=False
        )
    if kind == b"VP8L":
        (packed,) = struct.unpack_from("<I", content, 21)
        return _header(
            "image/webp",
            (packed & 0x3FFF) + 1,
            (packed >> 14 & 0x3FFF) + 1,
            exif=ExifFacts(),
            animated=False,
        )
    if kind != b"VP8X":
        message = "the first chunk is no picture"
        raise DamagedImageError(message)
    flags, sizes = struct.unpack_from("<B3x6s", content, 20)
    animated = bool(flags & 0x02)
    width = int.from_bytes(sizes[:3], "little") + 1
    height = int.from_bytes(sizes[3:], "little") + 1
    blocks = (
        content[start : start + length]
        for chunk, start, length in _riff_chunks(content)
        if chunk == b"EXIF"
    )
    exif = read_exif_facts(next(blocks, b"").removeprefix(EXIF_MARK))
    return _header("image/webp", width, height, exif=exif, animated=animated)


def _riff_chunks(content: bytes) -> Iterator[tuple[bytes, int, int]]:
    position = 12
    for _ in range(MAX_SEGMENTS):
        if position + 8 > len(content):
            return
        (length,) = struct.unpack_from("<I", content, position + 4)
        yield content[position : position + 4], position + 8, length
        position += 8 + length + (length & 1)


def _heif(content: bytes) -> ImageHeader:
    facts = read_heif_facts(content)
    # The size is that of the turned picture already.
    exif = ExifFacts(focal_length_35mm=read_exif_facts(facts.exif).focal_length_35mm)
    return _header(HEIC, facts.width, facts.height, exif=exif, animated=False)
