"""Reserved disk space for the embedded database, given up when erasing needs it.

SQLite writes what it deletes to its log first, so on a full disk nothing can be erased to make
room: without this ``DELETE`` is answered 503 until somebody frees space by hand. A file of the
service's own therefore reserves 8 MB, and is truncated piece by piece until the erasing succeeds.
"""

import contextlib
import logging
import os
import shutil
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Final, TypeVar

from sqlalchemy.exc import OperationalError

from service.engine.driver_errors import is_full
from service.process.data_folder import PRIVATE_FILE
from service.settings import Settings

T = TypeVar("T")

LOG: Final = logging.getLogger(__name__)

PIECE_BYTES: Final = 1_048_576
"""Erasing a job changes about ten pages of 4 KiB."""

WHOLE_BYTES: Final = 8 * PIECE_BYTES


class Ballast:
    """A file that reserves space; several processes may share it. Without a path, does nothing."""

    def __init__(self, file: Path | None) -> None:
        self._file = file
        self._lock = threading.Lock()

    def fill(self) -> None:
        """Reserve what is missing, but no more than half of what is free."""
        if self._file is None:
            return
        with self._lock, contextlib.suppress(OSError):
            handle = os.open(self._file, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, PRIVATE_FILE)
            try:
                held = os.fstat(handle).st_size
                wanted = min(WHOLE_BYTES - held, shutil.disk_usage(self._file.parent).free // 2)
                pieces = wanted // PIECE_BYTES
                if pieces > 0:
                    _take(handle, held, pieces * PIECE_BYTES)
            finally:
                os.close(handle)

    def make_room(self) -> None:
        """Give up pieces until the database can be written, or nothing is left."""
        if self._file is None:
            return
        folder = self._file.parent
        while folder.is_dir() and shutil.disk_usage(folder).free < PIECE_BYTES:
            if not self._give_up():
                return

    def spend_on(self, erasing: Callable[[], T]) -> T:
        """Erase; if the disk is full, give up pieces until that succeeds or nothing is left."""
        while True:
            try:
                return erasing()
            except OperationalError as error:
                if not is_full(error) or not self._give_up():
                    raise
                LOG.warning("The disk is full; room that was held back is given up to erase.")

    def _give_up(self) -> bool:
        if self._file is None:
            return False
        with self._lock:
            try:
                held = self._file.stat().st_size
                if held > 0:
                    os.truncate(self._file, max(0, held - PIECE_BYTES))
            except OSError:
                return False
        return held > 0


def open_ballast(settings: Settings) -> Ballast:
    """The ballast of the embedded database; without effect for any other database."""
    return Ballast(settings.ballast_file if settings.is_database_embedded else None)


def _take(handle: int, held: int, size: int) -> None:
    try:
        os.posix_fallocate(handle, held, size)
    except OSError:
        # Some of it may have been taken.
        os.ftruncate(handle, held)
        raise
