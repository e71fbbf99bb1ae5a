"""The data folder: private to its owner, and checked before anything is stored in it."""

import getpass
import os
from pathlib import Path
from typing import Final

from service.process.private_files import make_private_folder, tighten, tighten_own_folder
from service.settings import SettingError, Settings

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
        raise _unusable(settings, f"it cannot be made ({_why(error)})") from error
    files = database_files(settings.database_file)
    for path in (folder, settings.blob_dir, *files):
        if path.exists() and not _may_write(path):
            raise _unusable(settings, f"{_user()} may not write {path}")
    own = {settings.blob_dir.name, settings.ballast_file.name, *(file.name for file in files)}
    tighten_own_folder(folder, own=own)
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


def _user() -> str:
    try:
        return f"user {getpass.getuser()}"
    except (KeyError, OSError):
        return f"user {os.geteuid()}"


def _why(error: OSError | RuntimeError) -> str:
    if isinstance(error, FileExistsError | NotADirectoryError):
        return f"{error.filename} lies at or below a file"
    if isinstance(error, OSError) and error.strerror:
        return f"{error.strerror}: {error.filename}"
    return str(error)
