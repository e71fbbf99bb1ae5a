"""Where a process keeps what is costly to make: compiled kernels and prepared models."""

import os
import stat
from contextlib import suppress
from pathlib import Path
from typing import Final

from service.process.kernels import keep_kernels

VARIABLE: Final = "FITTER_CACHE_DIR"


def keep_what_is_costly() -> None:
    """Settle both folders before the numerics are loaded, unless the environment names them."""
    keep_kernels()
    if VARIABLE not in os.environ:
        # No name: models are prepared by every process that needs them.
        os.environ[VARIABLE] = str(users_folder() or "")


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
