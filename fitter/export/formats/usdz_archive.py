"""The archive of a USDZ: a ZIP without compression whose files begin at multiples of 64 bytes.

Written with Python's own ``zipfile``: USD's writer notes when it was written, and the same body
would not give the same bytes.
"""

import io
import zipfile
from collections.abc import Mapping

ALIGNMENT = 64
_LOCAL_HEADER_BYTES = 30
_EXTRA_HEADER_BYTES = 4
_PADDING_ID = 0x1986
"""Of the extra field that pads, as USD's own writer numbers it."""


def usdz_archive(files: Mapping[str, bytes]) -> bytes:
    """Pack files by name; the first is what the archive shows."""
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_STORED) as packed:
        for name, content in files.items():
            # A ZipInfo of its own is dated 1980-01-01.
            entry = zipfile.ZipInfo(name)
            entry.extra = _padding(archive.tell() + _LOCAL_HEADER_BYTES + len(name.encode()))
            packed.writestr(entry, content)
    return archive.getvalue()


def _padding(start: int) -> bytes:
    """An extra field after which a file that would begin at ``start`` is aligned."""
    length = -(start + _EXTRA_HEADER_BYTES) % ALIGNMENT
    header = _PADDING_ID.to_bytes(2, "little") + length.to_bytes(2, "little")
    return header + bytes(length)
