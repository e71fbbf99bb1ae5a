"""How the C library keeps memory that is freed: by those that compute, and given back by hand."""

import ctypes
from collections.abc import Mapping
from contextlib import suppress
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
