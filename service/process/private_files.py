"""Folders and files that only their owner may look into."""

import os
import stat
from collections.abc import Collection
from pathlib import Path
from typing import Final

PRIVATE_FOLDER: Final = 0o700
PRIVATE_FILE: Final = 0o600
OTHERS: Final = 0o077
"""The bits of a mode that speak of anybody but the owner."""


def make_private_folder(folder: Path) -> None:
    """Make a folder, unless it is there; those above it are made as usual."""
    folder.mkdir(mode=PRIVATE_FOLDER, parents=True, exist_ok=True)


def make_private_file(path: Path) -> None:
    """Make an empty file, unless it is there."""
    os.close(os.open(path, os.O_CREAT | os.O_RDONLY | os.O_CLOEXEC, PRIVATE_FILE))


def tighten(path: Path) -> None:
    """Take from others what they may do with a file or folder, if it is there and ours to change.

    A symbolic link is left alone: what it leads to may be anybody's.
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


def tighten_own_folder(folder: Path, *, own: Collection[str]) -> None:
    """Tighten a folder that holds nothing but what is ours: another may be shared for a reason."""
    try:
        is_own = all(each.name in own for each in folder.iterdir())
    except OSError:
        return
    if is_own:
        tighten(folder)
