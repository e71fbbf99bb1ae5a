"""Liveness of workers: heartbeats are counted, never dated, so that no clock jump kills a worker.

A worker increments its ``beat`` every few seconds. A watcher adds up, by its own monotonic clock,
for how long it has looked and seen the number unchanged. Time in which it did not look does not
count: while the database is unavailable no worker can beat, and none may be declared dead for it.
On the watcher's own machine the process table is consulted as well: a process that is gone is dead
at once.
"""

import os
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import sqlalchemy as sa

from service.jobs.records import WorkerStatus


def this_machine() -> str:
    """Identify what shares a process table: host, boot and pid namespace."""
    boot = _read("/proc/sys/kernel/random/boot_id")
    try:
        namespace = str(Path("/proc/self/ns/pid").readlink())
    except OSError:
        namespace = ""
    return f"{os.uname().nodename}/{boot}/{namespace}"


def this_process() -> dict[str, str | int]:
    """Identify the calling process by columns of ``WORKERS``.

    They are unique across machines, even after its pid is reused.
    """
    pid = os.getpid()
    return {"machine": this_machine(), "pid": pid, "pid_started": _pid_started(pid)}


START_TIME_FIELD: Final = 19
"""Index of the start time in /proc/pid/stat, counted after the command name."""


def _pid_started(pid: int) -> str:
    """Start time of a process in ticks since boot; empty if no such process runs."""
    # The command name may hold spaces and parentheses; the fields after it do not.
    fields = _read(f"/proc/{pid}/stat").rpartition(")")[2].split()
    if len(fields) <= START_TIME_FIELD or fields[0] == "Z":
        return ""
    return fields[START_TIME_FIELD]


def _read(path: str) -> str:
    try:
        return Path(path).read_text().strip()
    except OSError:
        return ""


LONGEST_LOOK: Final = 0.25
"""The longest time between two looks that still counts as silence, as a share of the limit."""


@dataclass(slots=True)
class _Sight:
    beat: int
    silent_s: float = 0.0
    has_beaten: bool = False


class WorkerWatch:
    """Remembers each worker's heartbeat as last seen; thread-safe."""

    def __init__(
        self, *, dead_after_s: float, monotonic: Callable[[], float] = time.monotonic
    ) -> None:
        self._dead_after_s = dead_after_s
        self._monotonic = monotonic
        self._machine = this_machine()
        self._sights: dict[str, _Sight] = {}
        self._last_look: float | None = None
        self._lock = threading.Lock()

    def look(self, workers: Sequence[sa.Row[Any]]) -> list[WorkerStatus]:
        """Look at all rows of ``WORKERS``, and return what is known about each."""
        with self._lock:
            now = self._monotonic()
            passed = 0.0 if self._last_look is None else now - self._last_look
            self._last_look = now
            counted = min(passed, LONGEST_LOOK * self._dead_after_s)
            self._sights = {row.executor_id: self._sight(row, counted) for row in workers}
            return [self._status(row) for row in workers]

    def alive(self, workers: Sequence[sa.Row[Any]]) -> set[str]:
        """Return the executor ids of the workers that are not known to be dead."""
        return {status.executor_id for status in self.look(workers) if status.alive is not False}

    def _sight(self, row: sa.Row[Any], counted_s: float) -> _Sight:
        sight = self._sights.get(row.executor_id)
        if sight is None:
            return _Sight(row.beat)
        if sight.beat != row.beat:
            return _Sight(row.beat, has_beaten=True)
        sight.silent_s += counted_s
        return sight

    def _status(self, row: sa.Row[Any]) -> WorkerStatus:
        sight = self._sights[row.executor_id]
        runs = self._runs(row)
        if runs is False or sight.silent_s >= self._dead_after_s:
            alive = False
        else:
            alive = True if runs or sight.has_beaten else None
        return WorkerStatus(executor_id=row.executor_id, alive=alive, able=row.able)

    def _runs(self, row: sa.Row[Any]) -> bool | None:
        """Ask the process table; None if the worker is elsewhere, or if it cannot be told."""
        if row.machine != self._machine:
            return None
        try:
            os.kill(row.pid, 0)
        except ProcessLookupError:
            return False
        except PermissionError:
            # Another user's, who may be hidden from us: its heartbeat decides.
            pass
        stat = _read(f"/proc/{row.pid}/stat")
        return _pid_started(row.pid) == row.pid_started if stat else None
