"""Where a process keeps what is costly to make: compiled kernels and prepared models."""

import os
import stat
import sys
from contextlib import suppress
from pathlib import Path
from typing import Final

from service.process.work_folder import make_work_folder

VARIABLE: Final = "FITTER_CACHE_DIR"
KERNELS: Final = "NUMBA_CACHE_DIR"


def settle_folders() -> Path:
    """Settle all folders before the numerics are loaded; return the one for temporary files.

    Numba gets a folder that ends with this process, whatever the environment names: what is kept
    of it is kept by :mod:`service.worker.kernel_cache`. A process that has loaded it already has
    its folder. Everything else is kept in the user's folder unless the environment names another.
    """
    work = make_work_folder()
    if "numba" not in sys.modules:
        os.environ[KERNELS] = str(work / "kernels")
    if VARIABLE not in os.environ:
        # No name: models are prepared by every process that needs them.
        os.environ[VARIABLE] = str(users_folder() or "")
    return work


def users_folder() -> Path | None:
    """A folder of ours in the user's cache, if there is such a thing and nobody else writes there.

    What lies there is run as it is found. There are no models among the temporary files: those may
    be in memory, of which the models are to take less.
    """
    caches = os.environ.get("XDG_CACHE_HOME") or "~/.cache"
    # Without a home, and where nothing can be written.
    with suppress(RuntimeError, OSError):
        folder = Path(caches).expanduser() / "maquette"
        if folder.is_absolute():
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            found = folder.stat()
            private = stat.S_IMODE(found.st_mode) & (stat.S_IWGRP | stat.S_IWOTH) == 0
            if found.st_uid == os.geteuid() and private and os.access(folder, os.W_OK):
                return folder
    return None
