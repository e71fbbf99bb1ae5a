"""Folders and files that only their owner can access."""

import os
import stat
from collections.abc import Collection
from pathlib import Path
from typing import Final

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


def tighten_own_folder(folder: Path, *, own: Collection[str]) -> None:
    """Tighten a folder that holds nothing but ours: any other may be shared for a reason."""
    try:
        is_own = all(each.name in own for each in folder.iterdir())
    except OSError:
        return
    if is_own:
        tighten(folder)
