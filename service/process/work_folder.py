"""A process' own folder among the temporary files: private, and gone when the process is.

Whatever it and its children write for the time being goes there. A process that is killed cannot
remove its folder. The next one does: each holds a lock on a file in its own for as long as it runs.
"""

import fcntl
import os
import shutil
import tempfile
import time
from contextlib import suppress
from multiprocessing.util import Finalize
from pathlib import Path
from typing import Final

PREFIX: Final = "maquette-"
LOCK: Final = "lock"
VARIABLE: Final = "TMPDIR"

AFTER_FORK_SERVER: Final = -200
"""``multiprocessing`` removes the folder of its fork server, which lies in ours, at -100."""

YOUNG_S: Final = 60.0
"""A folder that has just been made may not be locked yet."""


_MADE: Final[dict[int, Path]] = {}
"""The folders of this process and of those it was forked from, by their ids."""


def make_work_folder() -> Path:
    """Make the folder, and have this process and its children keep temporary files there.

    A process that asks again is given the one it has: folders in folders would soon have names that
    are too long for sockets.
    """
    if os.getpid() in _MADE:
        return _MADE[os.getpid()]
    parent = Path(tempfile.gettempdir())
    remove_abandoned(parent)
    folder = Path(tempfile.mkdtemp(prefix=f"{PREFIX}{os.geteuid()}-", dir=parent))
    # Open for as long as the process runs, and not in those that it starts.
    _lock(folder)
    Finalize(None, shutil.rmtree, args=(folder, True), exitpriority=AFTER_FORK_SERVER)
    tempfile.tempdir = str(folder)
    os.environ[VARIABLE] = str(folder)
    _MADE[os.getpid()] = folder
    return folder


def remove_abandoned(parent: Path) -> None:
    """Remove the folders of processes of ours that run no more."""
    for folder in parent.glob(f"{PREFIX}{os.geteuid()}-*"):
        with suppress(OSError):
            found = folder.lstat()
            if found.st_uid == os.geteuid() and time.time() - found.st_mtime > YOUNG_S:
                descriptor = _lock(folder)
                shutil.rmtree(folder, ignore_errors=True)
                os.close(descriptor)


def is_abandoned(folder: Path) -> bool:
    """Whether the process that made a work folder runs no more."""
    with suppress(OSError):
        os.close(_lock(folder))
        return True
    return False


def _lock(folder: Path) -> int:
    """Take the lock of a folder.

    Raises
    ------
    OSError
        If somebody else has it.
    """
    descriptor = os.open(folder / LOCK, os.O_CREAT | os.O_RDWR | os.O_NOFOLLOW, 0o600)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(descriptor)
        raise
    return descriptor
