"""The data folder: private to its owner, checked before anything is stored, and never full."""

import os
import shutil
import stat
from pathlib import Path
from typing import Final

from service.settings import SettingError, Settings

PRIVATE_FOLDER: Final = 0o700
PRIVATE_FILE: Final = 0o600
OTHERS: Final = 0o077
"""The bits of a mode that concern anybody but the owner."""


def make_private_folder(folder: Path) -> None:
    """Create a folder unless it exists; those above it get the usual permissions."""
    folder.mkdir(mode=PRIVATE_FOLDER, parents=True, exist_ok=True)


def make_private_file(path: Path) -> None:
    """Create an empty file unless it exists."""
    os.close(os.open(path, os.O_CREAT | os.O_RDONLY | os.O_CLOEXEC, PRIVATE_FILE))


def tighten(path: Path) -> None:
    """Remove others' permissions on a file or folder, if it exists and we may change it.

    A symbolic link is left alone: its target may be anybody's.
    """
    try:
        found = path.lstat()
    except OSError:
        return
    if found.st_uid != os.geteuid() or stat.S_ISLNK(found.st_mode):
        return
    mode = stat.S_IMODE(found.st_mode)
    if mode & OTHERS:
        path.chmod(mode & ~OTHERS)


DATABASE_ENDINGS: Final = ("", "-wal", "-shm", "-journal")


def database_files(database: Path) -> list[Path]:
    """The file of an embedded database, and those that SQLite keeps next to it."""
    return [database.with_name(database.name + ending) for ending in DATABASE_ENDINGS]


def prepare_data_folder(settings: Settings) -> None:
    """Create the folder, unless nothing is kept there; deny others access to what is ours.

    Raises
    ------
    SettingError
        If it cannot be made, or what is in it cannot be written.
    """
    if not settings.uses_data_folder:
        return
    try:
        folder = settings.data_dir.resolve()
        make_private_folder(folder)
        if settings.blob_url is None:
            make_private_folder(settings.blob_dir)
    # Python reports a loop of links with an error that is not an OSError.
    except (OSError, RuntimeError) as error:
        raise _unusable(settings, f"it cannot be made ({error})") from error
    files = database_files(settings.database_file)
    for path in (folder, settings.blob_dir, *files):
        if path.exists() and not _may_write(path):
            raise _unusable(settings, f"user {os.geteuid()} may not write {path}")
    own = {settings.blob_dir.name, *(file.name for file in files)}
    # A folder that holds anything but ours may be shared for a reason.
    if all(each.name in own for each in folder.iterdir()):
        tighten(folder)
    tighten(settings.blob_dir)


def _may_write(path: Path) -> bool:
    wanted = os.R_OK | os.W_OK | (os.X_OK if path.is_dir() else 0)
    return os.access(path, wanted, effective_ids=os.access in os.supports_effective_ids)


def _unusable(settings: Settings, reason: str) -> SettingError:
    return SettingError(
        f"{reason}; name a folder that the user who runs the service owns, or let them own it",
        name="data_dir",
        value=settings.data_dir,
    )


BYTES_PER_MB = 1_000_000


class Disk:
    """Free space below a folder; without one nothing is kept here, and there is always room."""

    def __init__(self, folder: Path | None, *, reserve_bytes: int) -> None:
        self._folder = folder
        self._reserve_bytes = reserve_bytes

    def free_bytes(self) -> int | None:
        """Bytes that are left for us; None if nothing is kept here."""
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
