"""HEIF files put together for the tests, from pictures that were encoded before.

ISO/IEC 14496-12 (boxes) and 23008-12 (items and their properties). What is written is what phones
write: turned pictures, grids of tiles, depth maps, several pictures in one file.
"""

import struct
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from PIL import Image

DATA = Path(__file__).parent / "heif_data"
EIGHT_BITS = (DATA / "eight_bits.heic").read_bytes()
TEN_BITS = (DATA / "ten_bits.heic").read_bytes()
SAMPLE_LYING = (DATA / "sample_lying.heic").read_bytes()

ALPHA = b"urn:mpeg:hevc:2015:auxid:1\0"


def box(kind: bytes, *content: bytes) -> bytes:
    body = b"".join(content)
    return struct.pack(">I4s", 8 + len(body), kind) + body


def full(kind: bytes, *content: bytes, version: int = 0, flags: int = 0) -> bytes:
    return box(kind, struct.pack(">I", version << 24 | flags), *content)


def turned(quarters: int) -> bytes:
    """Anticlockwise quarter turns."""
    return box(b"irot", bytes([quarters]))


def mirrored(axis: int) -> bytes:
    """Axis 0 swaps top and bottom, 1 left and right."""
    return box(b"imir", bytes([axis]))


def cropped(width: int, height: int) -> bytes:
    """The middle of the picture."""
    return box(b"clap", struct.pack(">4I", width, 1, height, 1), struct.pack(">iIiI", 0, 1, 0, 1))


def size(width: int, height: int) -> bytes:
    return full(b"ispe", struct.pack(">II", width, height))


@dataclass(frozen=True)
class Coded:
    """A coded picture: its parameters, its bytes and its size as coded."""

    parameters: bytes
    content: bytes
    width: int
    height: int


def coded(file: bytes) -> Coded:
    """Take the one picture out of an encoder's file."""
    start = file.index(b"hvcC") - 4
    (length,) = struct.unpack_from(">I", file, start)
    place = file.index(b"ispe") + 8
    width, height = struct.unpack_from(">II", file, place)
    content = file[file.index(b"mdat") + 4 :]
    return Coded(file[start : start + length], content, width, height)


@dataclass(frozen=True)
class Item:
    """An item of the file, numbered from 1 in the order given."""

    kind: bytes
    content: bytes
    properties: Sequence[bytes] = ()
    refers: Sequence[tuple[bytes, Sequence[int]]] = field(default=())


def picture_item(
    picture: Coded, *properties: bytes, refers: Sequence[tuple[bytes, Sequence[int]]] = ()
) -> Item:
    properties = (picture.parameters, size(picture.width, picture.height), *properties)
    return Item(b"hvc1", picture.content, properties, refers)


def exif_item(exif: Image.Exif, *, of: int = 1) -> Item:
    tiff = exif.tobytes().removeprefix(b"Exif\0\0")
    content = struct.pack(">I", 6) + b"Exif\0\0" + tiff
    return Item(b"Exif", content, (), ((b"cdsc", (of,)),))


def grid_item(columns: int, rows: int, width: int, height: int, tiles: Sequence[int]) -> Item:
    content = struct.pack(">BBBBHH", 0, 0, rows - 1, columns - 1, width, height)
    return Item(b"grid", content, (size(width, height),), ((b"dimg", tiles),))


def heif(*items: Item, primary: int = 1, brand: bytes = b"heic") -> bytes:
    """Write a file of these items; the content is after the boxes, as phones have it."""
    start = box(b"ftyp", brand, bytes(4), b"mif1", brand)
    places = [0] * len(items)
    for _ in range(2):
        meta = _meta(items, primary, places)
        position = len(start) + len(meta) + 8
        for number, each in enumerate(items):
            places[number] = position
            position += len(each.content)
    return start + meta + box(b"mdat", *(each.content for each in items))


def phone_picture(
    picture: Coded, *, orientation: int, quarters: int, focal_length_35mm: int | None = None
) -> bytes:
    """A turned picture with EXIF data, which say the same of its orientation."""
    exif = Image.Exif()
    exif[0x0112] = orientation
    if focal_length_35mm is not None:
        exif.get_ifd(0x8769)[0xA405] = focal_length_35mm
    return heif(picture_item(picture, turned(quarters)), exif_item(exif))


def _meta(items: Sequence[Item], primary: int, places: Sequence[int]) -> bytes:
    known: list[bytes] = []
    associations = b""
    for number, each in enumerate(items, start=1):
        for content in each.properties:
            if content not in known:
                known.append(content)
        indices = bytes(known.index(content) + 1 for content in each.properties)
        associations += struct.pack(">HB", number, len(indices)) + indices
    entries = b"".join(
        full(b"infe", struct.pack(">HH4s", number, 0, each.kind), b"\0", version=2)
        for number, each in enumerate(items, start=1)
    )
    locations = b"".join(
        struct.pack(">HHHII", number, 0, 1, place, len(each.content))
        for number, (each, place) in enumerate(zip(items, places, strict=True), start=1)
    )
    references = b"".join(
        box(kind, struct.pack(f">HH{len(to)}H", number, len(to), *to))
        for number, each in enumerate(items, start=1)
        for kind, to in each.refers
    )
    return full(
        b"meta",
        full(b"hdlr", bytes(4), b"pict", bytes(13)),
        full(b"pitm", struct.pack(">H", primary)),
        full(b"iloc", b"\x44\x00", struct.pack(">H", len(items)), locations),
        full(b"iinf", struct.pack(">H", len(items)), entries),
        box(
            b"iprp",
            box(b"ipco", *known),
            full(b"ipma", struct.pack(">I", len(items)), associations),
        ),
        full(b"iref", references) if references else b"",
    )
