"""Where a process keeps what is costly to make: compiled kernels and prepared models.

Numba keeps what it compiles beside the code, from where `make setup` and the image have it. Where
nobody may write there, as in an image, a process has a folder with links to what lies there.
"""

import hashlib
import logging
import os
import shutil
import stat
import sys
from collections.abc import Iterator
from contextlib import suppress
from importlib.util import find_spec
from pathlib import Path
from typing import Final

from service.process.work_folder import make_work_folder

LOG: Final = logging.getLogger(__name__)

VARIABLE: Final = "FITTER_CACHE_DIR"
KERNELS: Final = "NUMBA_CACHE_DIR"

FILES: Final = "*.nb[ci]"
"""Numba's: an index for each kernel, and its code for each combination of types."""


def settle_folders() -> Path:
    """Settle all folders before the numerics are loaded; return the one for temporary files.

    What the environment names stays. A process that has loaded Numba already has its folder.
    """
    work = make_work_folder()
    if VARIABLE not in os.environ:
        # No name: models are prepared by every process that needs them.
        os.environ[VARIABLE] = str(users_folder() or "")
    # Set even to nothing, which is beside the code: a file of Numba's in the current folder would
    # else name a folder, whose kernels are run.
    named = os.environ.setdefault(KERNELS, "")
    if not named and "numba" not in sys.modules and not os.access(package(), os.W_OK):
        kernels = Path(os.environ[VARIABLE] or work) / "kernels"
        link_kernels(kernels)
        os.environ[KERNELS] = str(kernels)
    return work


def link_kernels(folder: Path, kept: Path | None = None) -> None:
    """Lay links into a folder for Numba's cache: to kernels beside the code, and to those kept."""
    for code, name in _folders():
        (folder / name).mkdir(mode=0o700, parents=True, exist_ok=True)
        places = [code / "__pycache__", *([] if kept is None else [kept / name])]
        for file in (file for place in places for file in place.glob(FILES)):
            link = folder / name / file.name
            if link.is_symlink():
                link.unlink()
            if not link.exists():
                link.symlink_to(file)


def keep_kernels(folder: Path, kept: Path | None = None) -> None:
    """Copy what was compiled into a folder of links to where Numba keeps kernels otherwise."""
    for code, name in _folders():
        for file in (folder / name).glob(FILES):
            if not file.is_symlink():
                try:
                    _copy(file, code / "__pycache__" if kept is None else kept / name)
                except OSError as error:
                    LOG.warning("Kernels cannot be kept; each start compiles them: %s", error)
                    return


def forget_kernels(folder: Path) -> None:
    """Remove the kernels of a folder, and the files that its links lead to."""
    for file in folder.rglob(FILES):
        with suppress(OSError):
            file.resolve().unlink(missing_ok=True)
        file.unlink(missing_ok=True)


def package() -> Path:
    """The fitter's folder, found without loading it."""
    found = find_spec("fitter")
    assert found is not None
    return Path(next(iter(found.submodule_search_locations or ())))


def _folders() -> Iterator[tuple[Path, str]]:
    """The folders of code that have kernels, and what each is called in a folder for the cache.

    Numba names it so itself (:mod:`numba.core.caching`), which is not to be loaded for this.
    """
    for code in sorted({source.parent for source in package().rglob("_*kernels.py")}):
        yield code, f"{code.name}_{hashlib.sha1(str(code).encode()).hexdigest()}"


def _copy(file: Path, folder: Path) -> None:
    """Copy it so that it is there as a whole or not at all."""
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    unfinished = folder / f"{file.name}.{os.getpid()}"
    try:
        shutil.copyfile(file, unfinished)
        unfinished.replace(folder / file.name)
    finally:
        unfinished.unlink(missing_ok=True)


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
