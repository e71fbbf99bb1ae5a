"""Prepared models kept in files: read in a hundredth of the time that preparing takes.

A file is mapped, not read: what processes use of it is in memory once for all of them. It is kept
in the folder that the environment variable FITTER_CACHE_DIR names, and nowhere if that is unset.
Like Numba's compiled kernels it is code to whoever reads it: the folder must be the user's own.
"""

import hashlib
import logging
import mmap
import os
import pickle
import platform
import sys
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any, Final, TypeVar

from fitter.numerics.checked_file import ALIGNED, DamagedFileError, check, write_checked

LOG: Final = logging.getLogger(__name__)

VARIABLE: Final = "FITTER_CACHE_DIR"

KEPT: Final = 4
"""Files, the newest: models of women and men, of two versions or two folders."""

_SUFFIX: Final = ".prepared"
_PACKAGES: Final = ("numpy", "scipy", "qdldl")
"""Of others, by whose functions models are prepared."""

_LENGTH_BYTES: Final = 8

Made = TypeVar("Made")


def kept(source: Path, make: Callable[[], Made]) -> Made:
    """Result of ``make``, or its earlier result of the same file by the same code.

    Arrays in it can be written to, which changes neither the file nor other processes'. What
    cannot be kept is made, and that is logged.

    Parameters
    ----------
    source
        The file of which it is made.
    make
        Makes it, and raises whatever is wrong with the file.
    """
    named = os.environ.get(VARIABLE)
    if not named or not source.is_file():
        return make()
    path = Path(named) / f"{_key(source)}{_SUFFIX}"
    try:
        return _read(path)
    except FileNotFoundError:
        pass
    except (DamagedFileError, OSError) as error:
        LOG.warning("A prepared model in %s is made anew: %s", path.parent, error)
    made = make()
    try:
        _write(path, made)
        _forget_old(path.parent)
        # What was made would be in memory, used or not.
        return _read(path)
    except OSError as error:
        LOG.warning("A prepared model could not be kept in %s: %s", path.parent, error)
    return made


def _key(source: Path) -> str:
    # By its name too: a man's file under a woman's name is at fault.
    digest = hashlib.sha256(source.name.encode())
    digest.update(source.read_bytes())
    digest.update(code_digest())
    return digest.hexdigest()


@cache
def code_digest() -> bytes:
    """A digest of the fitter's code, and of the packages by whose functions models are prepared."""
    digest = hashlib.sha256(f"{sys.version} {platform.machine()}".encode())
    for package in _PACKAGES:
        digest.update(f"{package} {version(package)}".encode())
    root = Path(__file__).parents[1]
    for path in sorted((*root.rglob("*.py"), *root.rglob("*.json"))):
        digest.update(f"{path.relative_to(root)} {path.stat().st_size}".encode())
        digest.update(path.read_bytes())
    return digest.digest()


def _write(path: Path, made: object) -> None:
    """A pickle without its arrays, their lengths, and then each of them at an even place."""
    buffers: list[pickle.PickleBuffer] = []
    pickled = pickle.dumps(made, protocol=5, buffer_callback=buffers.append)
    arrays = [buffer.raw() for buffer in buffers]
    head = pickle.dumps((pickled, [array.nbytes for array in arrays]))
    write_checked(path, [len(head).to_bytes(_LENGTH_BYTES), head, *arrays])


def _read(path: Path) -> Any:
    with path.open("rb") as file:
        check(file)
        # Private and not read-only: kernels are compiled for arrays that can be written.
        mapped = memoryview(mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_COPY))
    parts = _Parts(mapped)
    head = parts.taken(int.from_bytes(parts.taken(_LENGTH_BYTES)))
    pickled, lengths = pickle.loads(head)
    made = pickle.loads(pickled, buffers=[parts.taken(length) for length in lengths])
    with suppress(OSError):
        os.utime(path)
    return made


class _Parts:
    """The parts of a mapped file, one after the other."""

    def __init__(self, mapped: memoryview) -> None:
        self._mapped = mapped
        self._at = ALIGNED

    def taken(self, length: int) -> memoryview:
        """The next part."""
        end = self._at + length
        part = self._mapped[self._at : end]
        self._at = end + -end % ALIGNED
        return part


def _forget_old(folder: Path) -> None:
    files = sorted(folder.glob(f"*{_SUFFIX}"), key=lambda path: path.stat().st_mtime)
    for path in files[:-KEPT]:
        with suppress(FileNotFoundError):
            path.unlink()
