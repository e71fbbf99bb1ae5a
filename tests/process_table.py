"""What the kernel knows of the processes under test: who runs, for whom, and what they use."""

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

PARENT_FIELD = 1
OWN_TICKS = slice(11, 13)
ALL_TICKS = slice(11, 15)
"""Of /proc/pid/stat, counted after the command name: user and system ticks of the process, and then
those of its children that have ended."""

TICKS_PER_S = os.sysconf("SC_CLK_TCK")
KIB_PER_MIB = 1024.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Process:
    """A process that is no zombie; forked ones have a name and the command of another."""

    pid: int
    parent: int
    command: str
    name: str


def processes_with(variable: str, value: object) -> list[Process]:
    """All processes that were started with this in their environment, and those they forked."""
    wanted = f"{variable}={value}".encode()
    return [
        process for process in _processes() if wanted in _bytes(process.pid, "environ").split(b"\0")
    ]


def is_running(pid: int) -> bool:
    """Say whether a process exists and is no zombie."""
    return _process(pid) is not None


def processor_s(pid: int, *, with_ended_children: bool = False) -> float:
    """Processor seconds a process has used; nothing if it is gone."""
    fields = _stat(pid)[ALL_TICKS if with_ended_children else OWN_TICKS]
    return sum(map(int, fields)) / TICKS_PER_S


def own_memory_mib(pid: int) -> float:
    """Memory that the process shares with no other, so that it can be added up."""
    return sum(memory_mib(pid, ("Private_Clean", "Private_Dirty")))


def memory_mib(pid: int, fields: Sequence[str]) -> tuple[float, ...]:
    """What the kernel's account of a process's memory says of each field; nothing if it is gone."""
    lines = [line.split() for line in _bytes(pid, "smaps_rollup").decode().splitlines()[1:]]
    values = {line[0].removesuffix(":"): int(line[1]) / KIB_PER_MIB for line in lines}
    return tuple(values.get(field, 0.0) for field in fields)


def _processes() -> Iterator[Process]:
    for folder in Path("/proc").iterdir():
        if folder.name.isdecimal() and (process := _process(int(folder.name))) is not None:
            yield process


def _process(pid: int) -> Process | None:
    fields = _stat(pid)
    if not fields or fields[0] in ("Z", "X"):
        return None
    command = _bytes(pid, "cmdline").replace(b"\0", b" ").decode(errors="replace")
    name = _bytes(pid, "comm").decode(errors="replace").strip()
    return Process(pid=pid, parent=int(fields[PARENT_FIELD]), command=command, name=name)


def _stat(pid: int) -> list[str]:
    # The command name may hold spaces and parentheses; the fields after it do not.
    return _bytes(pid, "stat").rpartition(b")")[2].decode().split()


def _bytes(pid: int, name: str) -> bytes:
    try:
        return Path(f"/proc/{pid}/{name}").read_bytes()
    except OSError:
        return b""
