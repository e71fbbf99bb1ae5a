"""Confinement of a process before it decodes pictures: secrets, new privileges, writing, TCP.

A picture that takes over its decoder should find nothing worth having. The environment of the
service holds the database's address and passwords, so the fork server is executed anew with what
it needs of it, and so are those that it forks: ``/proc/PID/environ`` shows what a program was
executed with, whatever it has removed since. Linux keeps the rest by itself: ``no_new_privs``, and
Landlock (5.13 or later; TCP from 6.7 on) through its three system calls, as no package that wraps
them has a version 1.0. Elsewhere nothing is given up but the environment.
"""

import ctypes
import logging
import os
import signal
import struct
import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

from service.settings import PREFIX

LOG: Final = logging.getLogger(__name__)

NEEDED: Final = frozenset(
    f"{PREFIX}{name}"
    for name in (
        "CHILD_MEMORY_MB",
        # By which an operator tells whose process it is.
        "DATA_DIR",
        "DETECTOR_DIR",
        "LOG_FORMAT",
        "LOG_LEVEL",
        "MAX_PIXELS",
        "MODELS_DIR",
    )
) | {"HOME", "LANG", "PATH", "TMPDIR", "TZ", "LD_LIBRARY_PATH"}
NEEDED_BEGINNINGS: Final = (
    "LC_",
    "MALLOC_",
    "MKL_",
    "NUMBA_",
    "OMP_",
    "OPENBLAS_",
    "OPENCV_",
    "PYTHON",
    "XDG_CACHE_",
)

PR_SET_PDEATHSIG: Final = 1
PR_SET_NO_NEW_PRIVS: Final = 38


def without_secrets(environment: Mapping[str, str]) -> dict[str, str]:
    """Return what a process needs that decodes pictures."""
    return {
        name: value
        for name, value in environment.items()
        if name in NEEDED or name.startswith(NEEDED_BEGINNINGS)
    }


def forget_secrets() -> None:
    """Execute this program again, as the same process, unless it knows no more than it needs.

    To be called before anything is opened or loaded. No privileges can be gained afterwards.
    """
    needed = without_secrets(os.environ)
    if needed.keys() != os.environ.keys():
        os.execve(sys.executable, sys.orig_argv, needed)
    gain_no_privileges()


def gain_no_privileges() -> None:
    """Have no program that is executed from here on gain privileges."""
    _control(PR_SET_NO_NEW_PRIVS, 1)


@contextmanager
def ending_with_the_parent() -> Iterator[None]:
    """End this process if its parent ends meanwhile."""
    _control(PR_SET_PDEATHSIG, signal.SIGKILL)
    try:
        yield
    finally:
        _control(PR_SET_PDEATHSIG, 0)


def _control(option: int, value: int) -> None:
    with suppress(AttributeError, OSError):
        ctypes.CDLL(None).prctl(option, value, 0, 0, 0)


CREATE_RULESET, ADD_RULE, RESTRICT_SELF = 444, 445, 446
"""Landlock's system calls: numbers of every architecture but Alpha."""
ASK_VERSION: Final = 1
PATH_BENEATH: Final = 1

READING: Final = 0b1101
"""Of the rights on files: to execute, to read, and to list folders. They stay."""
RIGHTS_BY_VERSION: Final = {1: 13, 2: 14, 3: 15, 5: 16}
"""How many rights on files a version knows, from which on."""
NETWORK_SINCE: Final = 4
TCP: Final = 0b11
"""To bind and to connect."""

WRITABLE: Final = ("/dev/null", "/proc")
"""Beside its own folder: a process writes its name and its score for the kernel to ``/proc``."""


def write_only_below(folder: str) -> bool:
    """Let this process and those it forks write nowhere else, and open no TCP connections.

    Files that are open stay so. Returns whether the kernel offers it.
    """
    gain_no_privileges()
    try:
        _restrict([folder, *WRITABLE])
    except (AttributeError, OSError) as error:
        LOG.info("Processes of jobs are not confined to their folder (%s).", error)
        return False
    return True


def _restrict(writable: Iterable[str]) -> None:
    call = ctypes.CDLL(None, use_errno=True).syscall
    version = _done(call(CREATE_RULESET, None, ctypes.c_size_t(0), ASK_VERSION))
    rights = max(count for since, count in RIGHTS_BY_VERSION.items() if since <= version)
    handled = (1 << rights) - 1 & ~READING
    attributes = struct.pack("=QQ", handled, TCP)[: 16 if version >= NETWORK_SINCE else 8]
    rules = _done(call(CREATE_RULESET, attributes, ctypes.c_size_t(len(attributes)), 0))
    try:
        for path in filter(os.path.exists, writable):
            beneath = os.open(path, os.O_PATH | os.O_CLOEXEC)
            try:
                allowed = handled if Path(path).is_dir() else handled & FILE_RIGHTS
                rule = struct.pack("=Qi", allowed, beneath)
                _done(call(ADD_RULE, rules, PATH_BENEATH, rule, 0))
            finally:
                os.close(beneath)
        _done(call(RESTRICT_SELF, rules, 0))
    finally:
        os.close(rules)


FILE_RIGHTS: Final = 1 << 1 | 1 << 14 | 1 << 15
"""Those that a rule for a single file may name: to write, to truncate, to control a device."""


def _done(result: int) -> int:
    if result < 0:
        number = ctypes.get_errno()
        raise OSError(number, os.strerror(number))
    return result
