"""A whole service whose processes are killed at random and started again."""

import contextlib
import os
import random
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path

from tests.object_storage import variable
from tests.process_table import Process, processes_with

REPOSITORY = Path(__file__).parents[1]
STOPPED_WITHIN_S = 600.0
PORTS_FROM = 20_000
PORT_RANGE = Path("/proc/sys/net/ipv4/ip_local_port_range")
FORK_SERVER = "multiprocessing.forkserver"
FOLDER_VARIABLE = "MAQUETTE_DATA_DIR"


class Kind(StrEnum):
    """Which process is killed."""

    API = "API"
    WORKER = "worker"
    FIT = "fit"
    FORK_SERVER = "fork server"
    ESTIMATOR = "estimator"


@dataclass(frozen=True, slots=True, kw_only=True)
class Commands:
    """How the API (with a worker of its own) and a further worker are started."""

    serve: tuple[str, ...]
    worker: tuple[str, ...]


REAL = Commands(
    serve=(sys.executable, "-m", "service.cli", "serve"),
    worker=(sys.executable, "-m", "service.cli", "worker"),
)

SETTINGS: Mapping[str, object] = {
    "heartbeat_s": 0.5,
    "dead_after_s": 5.0,
    "worker_processes": 1,
    # Whoever is killed here is killed by us: no picture is to be given up for it.
    "max_crashes": 1_000,
    "log_level": "INFO",
}


@dataclass
class Deployment:
    """`maquette serve` with its worker, and `maquette worker` beside it, on one data folder.

    What ends is started again, as an init system would; ``ended_unasked`` counts what ended without
    having been killed.
    """

    folder: Path
    commands: Commands = REAL
    database_url: str | None = None
    settings: Mapping[str, object] = field(default_factory=dict[str, object])
    workers: int = 1
    ended_unasked: int = 0

    def __post_init__(self) -> None:
        self.port = _free_port()
        self._killed: set[int] = set()
        self._running: list[tuple[tuple[str, ...], subprocess.Popen[bytes]]] = []

    @property
    def address(self) -> str:
        """Where the API listens, whenever it does."""
        return f"http://127.0.0.1:{self.port}"

    @property
    def log(self) -> Path:
        """What all processes have to say."""
        return self.folder / "log.txt"

    def start(self) -> None:
        """Start everything."""
        self.folder.mkdir(parents=True, exist_ok=True)
        for command in (self.commands.serve, *[self.commands.worker] * self.workers):
            self._start(command)

    def keep_running(self) -> None:
        """Start again what has ended."""
        for command, process in list(self._running):
            if process.poll() is None:
                continue
            self._running.remove((command, process))
            self._closed(process)
            self.ended_unasked += process.pid not in self._killed
            self._start(command)

    def stop(self) -> None:
        """Ask everything to stop, and wait for it."""
        for _, process in self._running:
            process.send_signal(signal.SIGTERM)
        for _, process in self._running:
            process.wait(STOPPED_WITHIN_S)
            self._closed(process)
        self._running.clear()

    def end(self) -> None:
        """Kill what is still there, however the run went."""
        for _, process in self._running:
            process.kill()
            process.wait()
            self._closed(process)
        self._running.clear()
        for process in self.processes():
            _kill(process.pid)

    def kill(self, kind: Kind, chance: random.Random) -> bool:
        """Kill one process of a kind; say whether there was one."""
        victims = self.of_kind(kind)
        if not victims:
            return False
        victim = chance.choice(sorted(victims, key=lambda process: process.pid))
        self._killed.add(victim.pid)
        _kill(victim.pid)
        return True

    def of_kind(self, kind: Kind) -> list[Process]:
        """The processes of a kind that run now."""
        processes = self.processes()
        fork_servers = {each.pid for each in processes if FORK_SERVER in each.command}
        return [each for each in processes if _kind(each, fork_servers) is kind]

    def processes(self) -> list[Process]:
        """Every process of this service, to the last child."""
        return processes_with(FOLDER_VARIABLE, self.folder)

    def _start(self, command: tuple[str, ...]) -> None:
        with self.log.open("ab") as log:
            process = subprocess.Popen(
                command,
                cwd=REPOSITORY,
                env=self._environment(),
                # A pipe, which some workers take for the life of whoever started them.
                stdin=subprocess.PIPE,
                stdout=log,
                stderr=log,
                start_new_session=True,
            )
        self._running.append((command, process))

    def _closed(self, process: subprocess.Popen[bytes]) -> None:
        if process.stdin is not None:
            process.stdin.close()

    def _environment(self) -> dict[str, str]:
        values = {**SETTINGS, **self.settings, "port": self.port}
        if self.database_url is not None:
            values["database_url"] = self.database_url
        inherited = {
            name: value for name, value in os.environ.items() if not name.startswith("MAQUETTE_")
        }
        return inherited | {FOLDER_VARIABLE: str(self.folder)} | dict(map(variable, values.items()))


def _kind(process: Process, fork_servers: set[int]) -> Kind | None:
    if process.name in ("estimator", "header"):
        return Kind.ESTIMATOR
    if process.pid in fork_servers:
        return Kind.FIT if process.parent in fork_servers else Kind.FORK_SERVER
    for kind, sign in (
        (Kind.ESTIMATOR, "estimat"),
        # Before the worker's: the API may have been told --no-worker.
        (Kind.API, "serve"),
        (Kind.WORKER, "worker"),
    ):
        if sign in process.command:
            return kind
    return None


def _kill(pid: int) -> None:
    try:
        os.kill(pid, signal.SIGKILL)
    except ProcessLookupError:
        return


def _free_port() -> int:
    """A port that no outgoing connection gets, so that it is there for an API started again.

    Where all are given to outgoing connections it is one of those.
    """
    ports_to = int(PORT_RANGE.read_text().split()[0])
    while True:
        port = random.randrange(PORTS_FROM, ports_to) if ports_to > PORTS_FROM else 0
        with socket.socket() as listener, contextlib.suppress(OSError):
            listener.bind(("127.0.0.1", port))
            return listener.getsockname()[1]


def wait_for(condition: Callable[[], bool], *, within_s: float) -> bool:
    """Wait for a condition; say whether it came."""
    deadline = time.monotonic() + within_s
    while not condition():
        if time.monotonic() > deadline:
            return False
        time.sleep(0.05)
    return True
