"""Pictures of every accepted kind, sound and damaged, with EXIF blocks sound and damaged."""

import io
import random
import struct
from functools import cache
from typing import Any

import numpy as np
from PIL import Image

from tests.fuzz.mutations import damaged
from tests.heif_files import EIGHT_BITS, coded, phone_picture

SIZE = (72, 96)
ORIENTATION = 0x0112
EXIF_DIRECTORY = 0x8769
FOCAL_TAGS = (0x920A, 0xA002, 0xA20E, 0xA210, 0xA405)
ORIENTATIONS = (0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 255, 65_535)
NUMBERS = (0, 1, 35, 50, 65_535, 2**32 - 1)


def picture(chance: random.Random) -> bytes:
    """A sound picture, one in eight; else one damaged somewhere, often in its EXIF block."""
    if chance.random() < 0.1:
        return _heic(chance)
    options = chance.choice(_FORMS)
    exif = b"Exif\0\0" + _exif(chance) if chance.random() < 0.7 else b""
    content = _encoded(options, exif[:60_000])
    if chance.random() < 0.125:
        return content
    if exif and chance.random() < 0.5:
        return content.replace(exif[6:], damaged(exif[6:], chance))
    return damaged(content, chance)


def black_mask() -> bytes:
    """A mask of nobody: the fit decodes everything and ends there."""
    stream = io.BytesIO()
    Image.new("L", SIZE, 0).save(stream, "PNG")
    return stream.getvalue()


def sound_picture() -> bytes:
    """A picture with nothing wrong."""
    return _encoded({"kind": "JPEG", "mode": "RGB"}, b"")


_FORMS: tuple[dict[str, Any], ...] = (
    {"kind": "JPEG", "mode": "RGB"},
    {"kind": "JPEG", "mode": "RGB", "progressive": True},
    {"kind": "JPEG", "mode": "L"},
    {"kind": "JPEG", "mode": "CMYK"},
    {"kind": "PNG", "mode": "RGB"},
    {"kind": "PNG", "mode": "RGBA"},
    {"kind": "PNG", "mode": "P"},
    {"kind": "PNG", "mode": "I;16"},
    {"kind": "PNG", "mode": "LA"},
    {"kind": "WEBP", "mode": "RGB"},
    {"kind": "WEBP", "mode": "RGB", "lossless": True},
    {"kind": "WEBP", "mode": "RGBA"},
)


def _heic(chance: random.Random) -> bytes:
    content = phone_picture(
        coded(EIGHT_BITS),
        orientation=chance.choice(ORIENTATIONS),
        quarters=chance.randrange(4),
        focal_length_35mm=chance.choice((None, 0, 26)),
    )
    return content if chance.random() < 0.125 else damaged(content, chance)


def _encoded(options: dict[str, Any], exif: bytes) -> bytes:
    kind, mode, rest = options["kind"], options["mode"], dict(options)
    del rest["kind"], rest["mode"]
    stream = io.BytesIO()
    # A copy: Pillow notes the encoder's settings on what it saves, and several senders save.
    _pixels(mode).copy().save(stream, kind, **rest, **({"exif": exif} if exif else {}))
    return stream.getvalue()


@cache
def _pixels(mode: str) -> Image.Image:
    values = np.random.default_rng(7).integers(0, 256, (*SIZE[::-1], 3), dtype=np.uint8)
    if mode == "I;16":
        return Image.fromarray(values[..., 0].astype(np.uint16) * 257)
    return Image.fromarray(values).convert(mode)


def _exif(chance: random.Random) -> bytes:
    """A TIFF block with an orientation and the tags that tell a focal length."""
    order = chance.choice("<>")
    head = (b"II" if order == "<" else b"MM") + struct.pack(f"{order}HI", 42, 8)
    first = [
        (ORIENTATION, 3, 1, struct.pack(f"{order}HH", chance.choice(ORIENTATIONS), 0)),
        (EXIF_DIRECTORY, 4, 1, struct.pack(f"{order}I", chance.choice((38, 38, 38, 8, 0, 2**31)))),
    ]
    # TIFF types, from BYTE to DOUBLE, and a few that do not exist.
    inner = [
        (
            tag,
            chance.choice((3, 4, 5, chance.randrange(16))),
            chance.choice((0, 1, 1, 1, 2**32 - 1)),
        )
        for tag in FOCAL_TAGS
    ]
    tail = [
        (tag, kind, count, struct.pack(f"{order}I", chance.choice(NUMBERS)))
        for tag, kind, count in inner
    ]
    block = head + _directory(first, order) + _directory(tail, order)
    return block + struct.pack(f"{order}II", chance.choice(NUMBERS), chance.choice(NUMBERS))


def _directory(entries: list[tuple[int, int, int, bytes]], order: str) -> bytes:
    packed = b"".join(
        struct.pack(f"{order}HHI", tag, kind, count) + value for tag, kind, count, value in entries
    )
    return struct.pack(f"{order}H", len(entries)) + packed + bytes(4)
