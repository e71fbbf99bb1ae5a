"""What a process keeps of memory that it has no more use for, and how it is given back by hand.

The C library keeps what is freed; the kernel keeps in place what has been read of a file once.
"""

import ctypes
import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Final

KEPT: Final[Mapping[str, str]] = {
    "MALLOC_MMAP_THRESHOLD_": str(32 * 1024 * 1024),
    "MALLOC_TRIM_THRESHOLD_": str(1024 * 1024 * 1024),
}
"""In the environment of a process, these have it keep what it frees for what it allocates next. A
fit frees and allocates the same megabytes over and over: given back each time, every page of them
would be a fault and filled with zeros again. The GNU C library alone knows them."""


def give_back() -> None:
    """Give back to the system what has been freed."""
    with suppress(AttributeError, OSError):
        ctypes.CDLL(None).malloc_trim(0)


DONT_NEED: Final = 4
"""Linux's MADV_DONTNEED: pages of a file that nobody has written to are read from it again."""

MAPPING: Final = re.compile(
    r"^([0-9a-f]+)-([0-9a-f]+) r..[ps] \S+ \S+ \d+ +/.*\n(?:[A-Z]\w+:.*\n)*?Anonymous: +0 kB$",
    flags=re.MULTILINE,
)
"""In the kernel's account of a process's memory: a file's pages, none of them written to."""


def give_back_files() -> None:
    """Let go of the pages of libraries and other files, which come back when they are used.

    Loading a library reads most of its pages once. A process that has loaded what others use, as a
    fork server, has no use for them; those it forks begin without them in any case.
    """
    with suppress(AttributeError, OSError):
        advise = ctypes.CDLL(None).madvise
        for start, size in _read_only():
            advise(ctypes.c_void_p(start), ctypes.c_size_t(size), DONT_NEED)


def _read_only() -> Iterator[tuple[int, int]]:
    for found in MAPPING.finditer(Path("/proc/self/smaps").read_text()):
        start, end = (int(address, base=16) for address in found.groups())
        yield start, end - start
