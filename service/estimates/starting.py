"""How an estimator is started: by a command, or forked by the worker beside the API.

The process gets one end of a socket. What is returned says whether it still runs, and kills it.
"""

import contextlib
import os
import select
import signal
import socket
import subprocess
from collections.abc import Callable, Mapping, Sequence
from typing import Final, Protocol

UNKNOWN: Final = -1
"""In place of the exit status of a process that is nobody's child here."""


class Started(Protocol):
    """A process that has been started, or soon is."""

    def named(self, pid: int) -> None:
        """Take the number that the process says it has."""
        ...

    def has_ended(self) -> bool:
        """Say whether the process is known to have ended."""
        ...

    def kill(self) -> int:
        """Kill it if it still runs, wait for its end, and return its exit status."""
        ...


Start = Callable[[socket.socket], Started]


def by_command(command: Sequence[str], *, environment: Mapping[str, str]) -> Start:
    """Start a process of our own, with the number of its end as its last argument."""

    def start(theirs: socket.socket) -> Started:
        # A session of its own: an interrupt from the terminal is for the API alone.
        process = subprocess.Popen(
            [*command, str(theirs.fileno())],
            pass_fds=[theirs.fileno()],
            stdin=subprocess.DEVNULL,
            env=dict(environment),
            start_new_session=True,
        )
        return _OwnProcess(process)

    return start


def by_passing_on(pass_on: Callable[[socket.socket], None]) -> Start:
    """Have somebody else fork the process, who is passed its end."""

    def start(theirs: socket.socket) -> Started:
        pass_on(theirs)
        return _LentProcess()

    return start


def can_watch_processes() -> bool:
    """Say whether processes can be watched and killed that are nobody's children here."""
    try:
        os.close(os.pidfd_open(os.getpid()))
    except (AttributeError, OSError):
        return False
    return True


class _OwnProcess:
    def __init__(self, process: subprocess.Popen[bytes]) -> None:
        self._process = process

    def named(self, pid: int) -> None:
        """Nothing to take: it is known."""

    def has_ended(self) -> bool:
        return self._process.poll() is not None

    def kill(self) -> int:
        self._process.kill()
        return self._process.wait()


class _LentProcess:
    """Held by a descriptor and not by its number, which another may have got by now.

    Until it is named it is not known to run: killing it then is to close our end, by which it ends.
    """

    def __init__(self) -> None:
        self._descriptor: int | None = None
        self._is_over = False

    def named(self, pid: int) -> None:
        try:
            self._descriptor = os.pidfd_open(pid)
        except ProcessLookupError:
            self._is_over = True

    def has_ended(self) -> bool:
        if self._descriptor is None:
            return self._is_over
        return _is_readable(self._descriptor, timeout_s=0.0)

    def kill(self) -> int:
        self._is_over = True
        if self._descriptor is not None:
            with contextlib.suppress(ProcessLookupError):
                signal.pidfd_send_signal(self._descriptor, signal.SIGKILL)
            _is_readable(self._descriptor, timeout_s=None)
            os.close(self._descriptor)
            self._descriptor = None
        return UNKNOWN


def _is_readable(descriptor: int, *, timeout_s: float | None) -> bool:
    poll = select.poll()
    poll.register(descriptor, select.POLLIN)
    return bool(poll.poll(None if timeout_s is None else timeout_s * 1000))
