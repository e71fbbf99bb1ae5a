"""Who is alive: heartbeats counted, never dated, so that no jump of a clock kills a worker.

A worker raises its ``beat`` every few seconds. Whoever watches remembers when, by its own
monotonic clock, it last saw the number change. On the watcher's own machine the process table is
asked as well: a process that is gone is dead at once.
"""

import os
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import sqlalchemy as sa


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessIdentity:
    """A process, told apart from every other one on any machine, even after its pid is reused."""

    machine: str
    pid: int
    pid_started: str


def this_machine() -> str:
    """Name what shares a process table: host, boot and pid namespace."""
    boot = _read("/proc/sys/kernel/random/boot_id")
    try:
        namespace = str(Path("/proc/self/ns/pid").readlink())
    except OSError:
        namespace = ""
    return f"{os.uname().nodename}/{boot}/{namespace}"


def this_process() -> ProcessIdentity:
    """Identify the calling process."""
    pid = os.getpid()
    return ProcessIdentity(machine=this_machine(), pid=pid, pid_started=_pid_started(pid))


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


class WorkerWatch:
    """Remembers what was seen of each worker's heartbeat."""

    def __init__(
        self, *, dead_after_s: float, monotonic: Callable[[], float] = time.monotonic
    ) -> None:
        self._dead_after_s = dead_after_s
        self._monotonic = monotonic
        self._machine = this_machine()
        self._seen: dict[str, tuple[int, float]] = {}

    def alive(self, workers: Sequence[sa.Row[Any]]) -> set[str]:
        """Return the executor ids of the workers that are alive, of all rows of their table."""
        now = self._monotonic()
        known: dict[str, tuple[int, float]] = {}
        for row in workers:
            beat, since = self._seen.get(row.executor_id, (row.beat, now))
            known[row.executor_id] = (beat, since) if beat == row.beat else (row.beat, now)
        self._seen = known
        return {
            row.executor_id
            for row in workers
            if now - known[row.executor_id][1] < self._dead_after_s and not self._is_gone(row)
        }

    def _is_gone(self, row: sa.Row[Any]) -> bool:
        return row.machine == self._machine and _pid_started(row.pid) != row.pid_started
