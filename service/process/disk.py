"""The disk of the data folder, and how much of it is kept free."""

import shutil
from pathlib import Path

from service.settings import Settings

BYTES_PER_MB = 1_000_000


class Disk:
    """Free space below a folder; without one nothing is kept here, and there is always room."""

    def __init__(self, folder: Path | None, *, reserve_bytes: int) -> None:
        self._folder = folder
        self._reserve_bytes = reserve_bytes

    def free_bytes(self) -> int | None:
        """What is left for us; None if nothing is kept here."""
        if self._folder is None:
            return None
        folder = self._folder
        while not folder.exists():
            folder = folder.parent
        return shutil.disk_usage(folder).free

    def has_room_for(self, size: int = 0) -> bool:
        """Whether the reserve stays intact if ``size`` bytes are stored."""
        free = self.free_bytes()
        return free is None or free - size >= self._reserve_bytes


def open_disk(settings: Settings) -> Disk:
    """The disk that fills when jobs are accepted: none with Postgres and object storage."""
    return Disk(
        settings.data_dir.resolve() if settings.uses_data_folder else None,
        reserve_bytes=settings.min_free_disk_mb * BYTES_PER_MB,
    )
