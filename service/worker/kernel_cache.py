"""Compiled kernels, kept in one file with a checksum from one process to the next.

Numba keeps what it compiles in hundreds of files, and runs what it finds in them unseen: a
truncated one ends the process, a changed one computes something else. So its own cache lasts only
as long as the folder of a process and those that it forks (:mod:`service.process.work_folder`).
What is in it after a rehearsal is kept in one file, beside the code or in the user's cache.
A command keeps what it had to compile too, which may be less than fits need: the file says which
code was rehearsed, and a service that finds none or other code rehearses once.
That file is read as it was written or not at all, and whoever decodes pictures never writes it.
"""

import hashlib
import importlib
import logging
import os
import pickle
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any, Final

import fitter
from fitter.fits.kept_models import VARIABLE as USERS_CACHE
from fitter.fits.kept_models import code_digest
from fitter.numerics.checked_file import DamagedFileError, check, write_checked
from service.process.caches import KERNELS

LOG: Final = logging.getLogger(__name__)

PACKAGE: Final = Path(next(iter(fitter.__path__)))
SOURCES: Final = "_*kernels.py"
"""Where kernels are compiled from, by the convention of this package."""

FORMAT: Final = 2
"""Of the file: raised whenever :class:`KeptKernels` changes."""

Signature = tuple[str, str, Any]
"""A kernel's module and name, and the types that it is compiled for."""


@dataclass(frozen=True, slots=True, kw_only=True)
class KeptKernels:
    """What is kept: the files of Numba's cache by name, and what is compiled in them.

    ``sources`` are the stamps of the files that they were compiled from; ``rehearsed`` is the
    digest of the fitter's code whose rehearsal compiled all that it calls, empty if there was none.
    """

    rehearsed: bytes
    sources: Mapping[str, tuple[int, int]]
    signatures: tuple[Signature, ...]
    files: Mapping[str, bytes]

    def is_current(self) -> bool:
        """Whether nothing of it would have to be compiled anew."""
        return self.sources == _sources()

    def is_complete(self) -> bool:
        """Whether it is current, and a fit with the code of now would not have to compile more."""
        return self.is_current() and self.rehearsed == code_digest()


def make_kernels_ready(compile_all: Callable[[], bool]) -> None:
    """Have all kernels compiled in this process, by reading what is kept where it is complete.

    Where it is not, ``compile_all`` is run and says whether it came to its end; only then what it
    compiled is kept. Whatever it does should not stay in memory: it is run in a child where the
    result can be kept, else here.
    """
    if not os.environ.get(KERNELS):
        # Numba was loaded before it had a folder for this process, and keeps its own.
        compile_all()
        return
    kept = restore_kernels()
    if kept is None or not kept.is_complete():
        _do_in_child(lambda: keep_kernels(kept, rehearsed=True) if compile_all() else None)
        kept = read_kept()
    if kept is None or not kept.is_complete():
        compile_all()
        return
    for module, name, types in kept.signatures:
        getattr(importlib.import_module(module), name).compile(types)


def _do_in_child(work: Callable[[], object]) -> None:
    """Do it in a child of this process, which has no threads: its memory ends with it."""
    child = os.fork()
    if child == 0:
        status = os.EX_SOFTWARE
        try:
            work()
            status = os.EX_OK
        finally:
            os._exit(status)
    os.waitpid(child, 0)


@contextmanager
def kept_kernels(*, rehearsed: bool = False) -> Iterator[None]:
    """Restore the kernels for the work of a command, and keep what it had to compile.

    ``rehearsed`` says that this process has then made all that a rehearsal makes.

    Nothing of either where Numba was loaded before it had a folder for this process.
    """
    if not os.environ.get(KERNELS):
        yield
        return
    kept = restore_kernels()
    yield
    if (
        kept is None
        or not kept.is_current()
        or (rehearsed and not kept.is_complete())
        or set(_signatures()) - set(kept.signatures)
    ):
        keep_kernels(kept, rehearsed=rehearsed)


def restore_kernels() -> KeptKernels | None:
    """Lay what is kept into the folder of Numba's cache, before the first kernel is called."""
    kept = read_kept()
    if kept is not None:
        for name, content in kept.files.items():
            path = _folder() / name
            path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
            path.write_bytes(content)
    return kept


def keep_kernels(before: KeptKernels | None, *, rehearsed: bool) -> None:
    """Keep what is compiled for this process, where that can be written.

    So is what was restored ``before``, unless kernels have changed since.
    """
    signatures = tuple(_signatures())
    if not signatures:
        return
    digest = code_digest() if rehearsed else b""
    if before is not None and before.is_current():
        signatures = tuple(dict.fromkeys((*signatures, *before.signatures)))
        digest = digest or before.rehearsed
    files = {
        str(path.relative_to(_folder())): path.read_bytes()
        for pattern in ("*.nbi", "*.nbc")
        for path in _folder().rglob(pattern)
    }
    kept = KeptKernels(rehearsed=digest, sources=_sources(), signatures=signatures, files=files)
    for path in _places():
        try:
            write_checked(path, [pickle.dumps(kept)])
        except OSError as error:
            LOG.debug("Compiled kernels cannot be kept in %s: %s", path.parent, error)
        else:
            return
    LOG.warning("Compiled kernels cannot be kept: the next start compiles them again.")


def read_kept() -> KeptKernels | None:
    """Return what is kept for this processor and these versions; None if there is nothing.

    What is complete goes first: beside the code may lie less, where only others can write.
    """
    first: KeptKernels | None = None
    for path in _places():
        try:
            with path.open("rb") as file:
                check(file)
                kept: KeptKernels = pickle.load(file)
        except FileNotFoundError:
            continue
        except (DamagedFileError, OSError) as error:
            LOG.warning("Compiled kernels in %s are made anew: %s", path.parent, error)
            continue
        if kept.is_complete():
            return kept
        first = first or kept
    return first


def _folder() -> Path:
    return Path(os.environ[KERNELS])


def _places() -> Iterator[Path]:
    name = f"kernels-{_key()}.checked"
    yield PACKAGE / "__pycache__" / name
    if users := os.environ.get(USERS_CACHE):
        yield Path(users) / name


def _key() -> str:
    # Imported here: whoever keeps nothing does not load it.
    from llvmlite import binding

    processor = os.environ.get("NUMBA_CPU_NAME") or binding.get_host_cpu_name()
    features = os.environ.get("NUMBA_CPU_FEATURES")
    if features is None:
        with suppress(RuntimeError):
            features = binding.get_host_cpu_features().flatten()
    versions = (FORMAT, sys.version, version("numba"), version("llvmlite"))
    parts = (*versions, PACKAGE, processor, features)
    return hashlib.sha256("\n".join(map(str, parts)).encode()).hexdigest()[:16]


def _sources() -> dict[str, tuple[int, int]]:
    """By path within the package, what Numba tells versions of a source by."""
    stamps = {path: path.stat() for path in PACKAGE.rglob(SOURCES)}
    return {
        str(path.relative_to(PACKAGE)): (stamp.st_mtime_ns, stamp.st_size)
        for path, stamp in stamps.items()
    }


def _signatures() -> Iterator[Signature]:
    from numba.extending import is_jitted

    kernels: dict[int, Any] = {
        id(value): value
        for name, module in sorted(sys.modules.items())
        if name.startswith(f"{fitter.__name__}.")
        for value in vars(module).values()
        if is_jitted(value)
    }
    for kernel in kernels.values():
        for types in kernel.signatures:
            yield kernel.py_func.__module__, kernel.py_func.__name__, types
