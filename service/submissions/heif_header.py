"""What the boxes of a HEIF file say of its primary picture, read without decoding a pixel.

A phone's file holds many pictures: tiles of a grid, a thumbnail, a depth map. One is the primary,
and only its properties count here. How a picture is turned is a property of its own, and decoders
ignore what EXIF says of it; so does this.

Sources: ISO/IEC 14496-12 (boxes, items), 23008-12 (properties, Exif items).
"""

import struct
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

MAX_BOXES: Final = 20_000
"""No real file has more boxes or entries side by side; a made-up one would keep the reader busy."""


class HeifFaultError(Exception):
    """The boxes cannot be followed to the size."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HeifFacts:
    """Size of the primary picture as it is shown, and its EXIF block, empty if it has none."""

    width: int
    height: int
    exif: bytes


@dataclass(frozen=True, slots=True)
class _Box:
    kind: bytes
    start: int
    end: int


def read_heif_facts(content: bytes) -> HeifFacts:
    """Read the size and the EXIF block of the primary picture.

    Raises
    ------
    HeifFaultError
        If the boxes contradict themselves.
    struct.error
        If they end too early.
    """
    meta = _only(_boxes(content, 0, len(content)), b"meta")
    inner = tuple(_boxes(content, meta.start + 4, meta.end))
    primary = _item_number(content, _only(inner, b"pitm"))
    width = height = 0
    for each in _properties(content, _only(inner, b"iprp"), primary):
        if each.kind == b"ispe":
            width, height = struct.unpack_from(">II", content, each.start + 4)
        elif each.kind == b"clap":
            width, height = _cropped(content, each)
        elif each.kind == b"irot" and content[each.start] & 1:
            width, height = height, width
    if not width or not height:
        message = "its primary picture has no size"
        raise HeifFaultError(message)
    return HeifFacts(width=width, height=height, exif=_exif(content, inner, primary))


def _boxes(content: bytes, start: int, end: int) -> Iterator[_Box]:
    for _ in range(MAX_BOXES):
        if start + 8 > end:
            return
        length, kind = struct.unpack_from(">I4s", content, start)
        head = 8
        if length == 1:
            (length,) = struct.unpack_from(">Q", content, start + 8)
            head = 16
        elif length == 0:
            length = end - start
        if length < head:
            message = "a box is shorter than its head"
            raise HeifFaultError(message)
        yield _Box(kind, start + head, min(start + length, end))
        start += length


def _only(boxes: Iterator[_Box] | Sequence[_Box], kind: bytes) -> _Box:
    found = next((each for each in boxes if each.kind == kind), None)
    if found is None:
        message = f"the box '{kind.decode()}' is missing"
        raise HeifFaultError(message)
    return found


def _item_number(content: bytes, pitm: _Box) -> int:
    wide = content[pitm.start] > 0
    (number,) = struct.unpack_from(">I" if wide else ">H", content, pitm.start + 4)
    return number


def _properties(content: bytes, iprp: _Box, item: int) -> Iterator[_Box]:
    """The properties of an item, in the order in which decoders apply them."""
    inner = tuple(_boxes(content, iprp.start, iprp.end))
    container = _only(inner, b"ipco")
    known = tuple(_boxes(content, container.start, container.end))
    for each in inner:
        if each.kind == b"ipma":
            for index in _associated(content, each, item):
                # 0 stands for no property.
                if not 0 < index <= len(known):
                    continue
                yield known[index - 1]


def _associated(content: bytes, ipma: _Box, item: int) -> Sequence[int]:
    version, wide_indices = content[ipma.start], content[ipma.start + 3] & 1
    (entries,) = struct.unpack_from(">I", content, ipma.start + 4)
    position = ipma.start + 8
    for _ in range(min(entries, MAX_BOXES)):
        number, count = struct.unpack_from(">IB" if version else ">HB", content, position)
        position += 5 if version else 3
        form = f">{count}{'H' if wide_indices else 'B'}"
        if number == item:
            # The upper bit says that a reader must know the property.
            mask = 0x7FFF if wide_indices else 0x7F
            return [index & mask for index in struct.unpack_from(form, content, position)]
        position += struct.calcsize(form)
    return ()


def _cropped(content: bytes, clap: _Box) -> tuple[int, int]:
    width, width_by, height, height_by = struct.unpack_from(">4I", content, clap.start)
    if not width_by or not height_by:
        message = "its crop has no size"
        raise HeifFaultError(message)
    return round(width / width_by), round(height / height_by)


def _exif(content: bytes, inner: Sequence[_Box], primary: int) -> bytes:
    """The TIFF block of the item that describes the primary; what is damaged counts as absent."""
    try:
        describing = _describing(content, inner, primary)
        item = next((each for each in _items(content, inner, b"Exif") if each in describing), None)
        block = b"" if item is None else _item_content(content, inner, item)
        (offset,) = struct.unpack_from(">I", block)
    except (struct.error, IndexError, HeifFaultError):
        return b""
    return block[4 + offset :]


def _describing(content: bytes, inner: Sequence[_Box], item: int) -> frozenset[int]:
    iref = _only(inner, b"iref")
    form = "I" if content[iref.start] else "H"
    width = struct.calcsize(f">{form}")
    found: set[int] = set()
    for each in _boxes(content, iref.start + 4, iref.end):
        if each.kind != b"cdsc":
            continue
        source, count = struct.unpack_from(f">{form}H", content, each.start)
        if item in struct.unpack_from(f">{count}{form}", content, each.start + width + 2):
            found.add(source)
    return frozenset(found)


def _items(content: bytes, inner: Sequence[_Box], kind: bytes) -> Iterator[int]:
    iinf = _only(inner, b"iinf")
    head = 8 if content[iinf.start] else 6
    for each in _boxes(content, iinf.start + head, iinf.end):
        form = {2: ">HH4s", 3: ">IH4s"}.get(content[each.start])
        if form is None:
            continue
        number, _, found = struct.unpack_from(form, content, each.start + 4)
        if found == kind:
            yield number


def _item_content(content: bytes, inner: Sequence[_Box], item: int) -> bytes:
    iloc = _only(inner, b"iloc")
    version = content[iloc.start]
    offset_width, length_width = content[iloc.start + 4] >> 4, content[iloc.start + 4] & 15
    base_width = content[iloc.start + 5] >> 4
    index_width = content[iloc.start + 5] & 15 if version else 0
    wide = 4 if version == 2 else 2
    position = iloc.start + 6

    def take(width: int) -> int:
        nonlocal position
        if position + width > iloc.end:
            message = "the places of items end too early"
            raise HeifFaultError(message)
        value = int.from_bytes(content[position : position + width])
        position += width
        return value

    for _ in range(min(take(wide), MAX_BOXES)):
        number = take(wide)
        method = take(2) & 15 if version else 0
        take(2)
        base = take(base_width)
        extents = take(2)
        if number != item:
            position += extents * (index_width + offset_width + length_width)
            continue
        # Writers keep the block in one piece; of many they could make it larger than the file.
        if extents != 1:
            return b""
        take(index_width)
        start, length = base + take(offset_width), take(length_width)
        # Method 1 counts from the box 'idat', 0 from the beginning of the file.
        start += _only(inner, b"idat").start if method == 1 else 0
        return content[start : start + length] if length else content[start:]
    return b""
