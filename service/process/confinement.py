"""Confinement of processes that decode pictures: no secrets, no sockets, no files of others.

A picture that takes over its decoder should find nothing worth having. The environment of the
service holds the database's address and passwords, so the fork server is executed anew with what
it needs of it, and so are those that it forks: ``/proc/PID/environ`` shows what a program was
executed with, whatever it has removed since. Before a child takes its first task Linux closes the
rest, by system calls, as no package that wraps them is maintained:

- Landlock (5.13 or later) has it read code, models and its work folder alone, and write to the
  latter; of ``/proc`` it sees itself.
- A seccomp filter has it make no sockets of any kind, signal nobody but itself, and look into no
  other process. A network namespace would do for sockets, but not every user may make one.

Elsewhere nothing is given up but the environment.
"""

import ctypes
import logging
import os
import platform
import signal
import struct
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from importlib.util import find_spec
from pathlib import Path
from typing import Final

from service.settings import PREFIX, Settings

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
PR_SET_SECCOMP: Final = 22
FILTER_MODE: Final = 2


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


def confine(*, readable: Iterable[str], writable: str) -> bool:
    """Confine this process, which has one thread, and those that it forks.

    It reads what is below the first paths and below ``writable``, and writes below the latter
    alone. Files that are open stay so. Returns whether the kernel offers it all.
    """
    gain_no_privileges()
    rights = {**dict.fromkeys(readable, READING), writable: ALL_RIGHTS, **DEVICES}
    held = [_tried(lambda: _restrict_files(rights)), _tried(_restrict_calls)]
    return all(held)


def _tried(restrict: Callable[[], None]) -> bool:
    try:
        restrict()
    except (AttributeError, KeyError, OSError) as error:
        LOG.info("This system does not confine processes of jobs (%s).", error)
        return False
    return True


def readable_paths(settings: Settings) -> tuple[str, ...]:
    """Folders of code, its libraries and models, from which children load what they need.

    None of them holds the data folder, as that of a checkout may.
    """
    packages = [find_spec(name) for name in ("service", "fitter", "api_schemas")]
    data = settings.data_dir.resolve()
    named = [os.environ.get("NUMBA_CACHE_DIR"), settings.models_dir, settings.detector_dir]
    return (
        *(sys.prefix, sys.base_prefix, *LIBRARIES),
        *(path for each in packages if each for path in each.submodule_search_locations or ()),
        *(path for path in sys.path if path and not data.is_relative_to(Path(path).resolve())),
        *(str(path) for path in named if path),
    )


def warn_of_weakness() -> None:
    """Say why processes that decode pictures are confined less than they could be, if so."""
    if os.geteuid() == 0:
        LOG.warning(
            "This runs as root: name a user who may do less, in case a process is taken over."
        )
    try:
        landlock_version()
    except (AttributeError, OSError):
        LOG.warning("This system has no Landlock: processes of jobs may read this user's files.")


LIBRARIES: Final = (
    "/lib",
    "/lib64",
    "/usr/lib",
    "/usr/lib64",
    "/usr/local/lib",
    "/etc/ld.so.cache",
)

CREATE_RULESET, ADD_RULE, RESTRICT_SELF = 444, 445, 446
"""Landlock's system calls: numbers of every architecture but Alpha."""
ASK_VERSION: Final = 1
PATH_BENEATH: Final = 1

READING: Final = 0b1101
"""Rights to execute, to read, and to list folders."""
ALL_RIGHTS: Final = (1 << 16) - 1
FILE_RIGHTS: Final = 0b111 | 1 << 14 | 1 << 15
"""Rights that a rule for a single file may name: also to write, truncate and control a device."""
RIGHTS_BY_VERSION: Final = {1: 13, 2: 14, 3: 15, 5: 16}
"""Number of rights on files that a version knows, from which on."""

NETWORK_SINCE: Final = 4
TCP: Final = 0b11
"""To bind and to connect."""
SCOPES_SINCE: Final = 6
SCOPES: Final = 0b11
"""Abstract Unix sockets, and signals, of others."""

DEVICES: Final = {"/dev/null": ALL_RIGHTS, "/dev/urandom": READING}


def landlock_version() -> int:
    """Version of Landlock that the kernel offers.

    Raises
    ------
    OSError
        If it offers none.
    """
    return _called(CREATE_RULESET, None, ctypes.c_size_t(0), ASK_VERSION)


def _restrict_files(rights_below: Mapping[str, int]) -> None:
    version = landlock_version()
    handled = (
        1 << max(count for since, count in RIGHTS_BY_VERSION.items() if since <= version)
    ) - 1
    size = 8 if version < NETWORK_SINCE else 16 if version < SCOPES_SINCE else 24
    attributes = struct.pack("=QQQ", handled, TCP, SCOPES)[:size]
    rules = _called(CREATE_RULESET, attributes, ctypes.c_size_t(size), 0)
    try:
        for path, rights in rights_below.items():
            with suppress(FileNotFoundError):
                beneath = os.open(path, os.O_PATH | os.O_CLOEXEC)
                try:
                    allowed = (
                        rights & handled & (ALL_RIGHTS if Path(path).is_dir() else FILE_RIGHTS)
                    )
                    _called(ADD_RULE, rules, PATH_BENEATH, struct.pack("=Qi", allowed, beneath), 0)
                finally:
                    os.close(beneath)
        _called(RESTRICT_SELF, rules, 0)
    finally:
        os.close(rules)


ARCHITECTURES: Final = {"x86_64": 0xC000003E, "aarch64": 0xC00000B7}
"""Linux' names of instruction sets, as a filter sees them."""

DENIED: Final[Mapping[str, Sequence[int]]] = {
    # socket, socketpair, connect, bind, listen, sendto, sendmsg, sendmmsg;
    # ptrace, process_vm_readv, process_vm_writev; tkill, rt_sigqueueinfo, rt_tgsigqueueinfo.
    "x86_64": (41, 53, 42, 49, 50, 44, 46, 307, 101, 310, 311, 200, 129, 297),
    "aarch64": (198, 199, 203, 200, 201, 206, 211, 269, 117, 270, 271, 130, 138, 240),
}
"""Calls that are refused, by their numbers."""

DENIED_EVERYWHERE: Final = (424, 425, 426, 427, 438)
"""pidfd_send_signal; io_uring_setup, _enter and _register, which make sockets too; pidfd_getfd."""

SIGNALS: Final[Mapping[str, Sequence[int]]] = {"x86_64": (62, 234), "aarch64": (129, 131)}
"""kill and tgkill, which a process may use on itself."""

FOREIGN_CALLS: Final = 0x4000_0000
"""Numbers from here on are those of x32, an instruction set of its own on x86_64."""

LOAD, EQUAL, NOT_LESS, RETURN = 0x20, 0x15, 0x35, 0x06
"""Instructions of a filter: load a word, compare it and jump, return."""
NUMBER_AT, ARCHITECTURE_AT, FIRST_ARGUMENT_AT = 0, 4, 16
REFUSE, ALLOW = 0x0005_0000 | 1, 0x7FFF_0000
"""With EPERM, or not."""


def _restrict_calls() -> None:
    program = _filter(platform.machine(), os.getpid())
    code = ctypes.create_string_buffer(b"".join(struct.pack("=HBBI", *each) for each in program))
    header = struct.pack("@HP", len(program), ctypes.addressof(code))
    if ctypes.CDLL(None, use_errno=True).prctl(PR_SET_SECCOMP, FILTER_MODE, header, 0, 0) < 0:
        raise _error()


def _filter(machine: str, own: int) -> list[tuple[int, int, int, int]]:
    """Instructions: code, jumps over so many if true and if false, and a constant."""
    denied = (*DENIED[machine], *DENIED_EVERYWHERE)
    signals = SIGNALS[machine]
    to_refuse = len(denied) + len(signals) + 3
    checks = [
        *((EQUAL, to_refuse - at - 1, 0, number) for at, number in enumerate(denied)),
        *((EQUAL, len(signals) - at, 0, number) for at, number in enumerate(signals)),
    ]
    return [
        (LOAD, 0, 0, ARCHITECTURE_AT),
        (EQUAL, 1, 0, ARCHITECTURES[machine]),
        (RETURN, 0, 0, REFUSE),
        (LOAD, 0, 0, NUMBER_AT),
        (NOT_LESS, to_refuse, 0, FOREIGN_CALLS),
        *checks,
        (RETURN, 0, 0, ALLOW),
        (LOAD, 0, 0, FIRST_ARGUMENT_AT),
        (EQUAL, 1, 0, own),
        (RETURN, 0, 0, REFUSE),
        (RETURN, 0, 0, ALLOW),
    ]


def _called(number: int, *arguments: object) -> int:
    result = ctypes.CDLL(None, use_errno=True).syscall(number, *arguments)
    if result < 0:
        raise _error()
    return result


def _error() -> OSError:
    number = ctypes.get_errno()
    return OSError(number, os.strerror(number))
