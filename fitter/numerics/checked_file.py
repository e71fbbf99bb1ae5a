"""Files that are read as they were written or not at all: a checksum stands before the content.

A disk, a crash in the middle of writing or somebody's script may change a file that is kept only
to save time. Whoever reads it then makes what was in it anew.
"""

import os
import tempfile
import time
import zlib
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import IO, Final

ALIGNED: Final = 64
"""Bytes: where content and each of its parts begin is a multiple of this, as arrays like it."""

_MARK: Final = b"checked1"
_SUM_BYTES: Final = 4
_READ_AT_ONCE: Final = 1024 * 1024

_UNFINISHED: Final = ".new"
_ABANDONED_S: Final = 600.0
"""Writing takes a second: a file that is unfinished for so long was left by a process that died."""


class DamagedFileError(Exception):
    """The file is not what was written."""


def write_checked(path: Path, parts: Iterable[bytes | memoryview]) -> None:
    """Write the parts one after the other, each from an aligned place on, and their checksum.

    The file is there as a whole or not at all, even if the machine loses its power.

    Raises
    ------
    OSError
        If it cannot be written.
    """
    path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    _remove_abandoned(path.parent)
    with tempfile.NamedTemporaryFile(dir=path.parent, suffix=_UNFINISHED, delete=False) as file:
        try:
            file.write(bytes(ALIGNED))
            checksum = 0
            for part in parts:
                for piece in (part, bytes(-len(part) % ALIGNED)):
                    file.write(piece)
                    checksum = zlib.crc32(piece, checksum)
            file.seek(0)
            file.write(_MARK + checksum.to_bytes(_SUM_BYTES))
            file.flush()
            os.fsync(file.fileno())
            Path(file.name).replace(path)
        except OSError:
            Path(file.name).unlink()
            raise


def check(file: IO[bytes]) -> None:
    """Read an open file to its end and leave it at the beginning of the content.

    It is read and not mapped: pages that a process has mapped and read count as its memory.

    Raises
    ------
    DamagedFileError
        If the content is not what was written.
    """
    head = file.read(ALIGNED)
    expected = head[len(_MARK) : len(_MARK) + _SUM_BYTES]
    checksum = 0
    while piece := file.read(_READ_AT_ONCE):
        checksum = zlib.crc32(piece, checksum)
    if not head.startswith(_MARK) or checksum.to_bytes(_SUM_BYTES) != expected:
        message = "its checksum does not match"
        raise DamagedFileError(message)
    file.seek(ALIGNED)


def _remove_abandoned(folder: Path) -> None:
    for path in folder.glob(f"*{_UNFINISHED}"):
        with suppress(FileNotFoundError):
            if time.time() - path.stat().st_mtime > _ABANDONED_S:
                path.unlink()
