"""Where compiled kernels are kept: next to the code, in the user's cache, or in a folder of ours.

Numba knows the first two, and refuses to load the code at all if it can write to neither, for
instance in a service that was installed by somebody else and runs as a user without a home.
"""

import os
import stat
import tempfile
from collections.abc import Iterable
from contextlib import suppress
from importlib.resources import files
from pathlib import Path
from typing import Final

VARIABLE: Final = "NUMBA_CACHE_DIR"


def keep_kernels() -> None:
    """Settle the folder before the numerics are loaded, unless the environment names one."""
    if os.environ.get(VARIABLE):
        return
    folder = None if any(_can_be_written(place) for place in _numbas_own()) else own_folder()
    # No name leaves the choice to Numba. Unset, it would be read out of a file in the current
    # folder, and what lies there be taken for compiled code.
    os.environ[VARIABLE] = "" if folder is None else str(folder)


def own_folder(temporary: Path | None = None) -> Path:
    """The user's folder among the temporary files, the same one every time.

    Compiled code is run as it is found: if somebody else owns a folder of that name or may write to
    it, a new one is created.
    """
    temporary = temporary or Path(tempfile.gettempdir())
    folder = temporary / f"maquette-kernels-{os.geteuid()}"
    with suppress(FileExistsError):
        folder.mkdir(mode=0o700)
    found = folder.lstat()
    private = stat.S_IMODE(found.st_mode) & (stat.S_IWGRP | stat.S_IWOTH) == 0
    if stat.S_ISDIR(found.st_mode) and found.st_uid == os.geteuid() and private:
        return folder
    return Path(tempfile.mkdtemp(prefix=f"{folder.name}-", dir=temporary))


def _numbas_own() -> Iterable[Path]:
    yield Path(str(files("fitter"))) / "body" / "__pycache__"
    caches = os.environ.get("XDG_CACHE_HOME", "~/.cache")
    # Without a home there is no such folder.
    with suppress(RuntimeError):
        folder = Path(caches).expanduser() / "numba"
        if folder.is_absolute():
            yield folder


def _can_be_written(folder: Path) -> bool:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError:
        return False
    return True
