"""A service whose processes are of one version or the other, on one database and folder."""

import contextlib
import itertools
import os
import signal
import socket
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import httpx

from tests.deployment import wait_for
from tests.installation import Installation

READY_WITHIN_S = 600.0
STOPPED_WITHIN_S = 120.0
STOP_DELAY_S = 2
"""Requests that the load balancer has already sent an API process to are answered."""


@dataclass(frozen=True)
class Api:
    """An API process that a load balancer sends requests to."""

    process: subprocess.Popen[bytes]
    address: str


@dataclass
class Site:
    """What an operator has: a database, a folder of pictures, processes to start and to stop."""

    folder: Path
    database_url: str
    apis: list[Api] = field(default_factory=list[Api])
    workers: list[subprocess.Popen[bytes]] = field(default_factory=list[subprocess.Popen[bytes]])

    def prepare(self, version: Installation) -> subprocess.CompletedProcess[str]:
        """Run ``maquette prepare`` of a version."""
        return version.run(version.maquette, "prepare", cwd=self.folder, **self._settings())

    def start_api(self, version: Installation) -> None:
        """Start an API process and wait until it listens."""
        port = _free_port()
        process = self._start(version, "serve", "--no-worker", "--port", str(port))
        api = Api(process, f"http://127.0.0.1:{port}")
        assert wait_for(lambda: _listens(api), within_s=READY_WITHIN_S), "the API does not listen"
        self.apis.append(api)

    def start_worker(self, version: Installation) -> None:
        """Start a worker and wait until the API counts it."""
        self.workers.append(self._start(version, "worker"))
        assert wait_for(self._all_workers_are_ready, within_s=READY_WITHIN_S), "no worker came"

    def stop_oldest_api(self) -> int:
        """Take it from the load balancer, ask it to stop, and wait; returns its exit status."""
        return _stopped(self.apis.pop(0).process)

    def stop_oldest_worker(self) -> int:
        """Ask it to stop, and wait; returns its exit status."""
        return _stopped(self.workers.pop(0))

    @property
    def address(self) -> str:
        """Where the next request goes: to each API in turn."""
        self.apis.append(self.apis.pop(0)) if len(self.apis) > 1 else None
        return self.apis[0].address

    def end(self) -> None:
        """Kill what still runs."""
        for process in itertools.chain((api.process for api in self.apis), self.workers):
            process.kill()
            process.wait()

    def _all_workers_are_ready(self) -> bool:
        ready = httpx.get(f"{self.apis[0].address}/healthz/ready", timeout=60.0)
        assert all(worker.poll() is None for worker in self.workers), "a worker ended"
        return ready.json().get("workers", 0) == len(self.workers)

    def _start(self, version: Installation, *arguments: str) -> subprocess.Popen[bytes]:
        with (self.folder / "log.txt").open("ab") as log:
            return subprocess.Popen(
                [version.maquette, *arguments],
                cwd=self.folder,
                env=version.environment() | self._settings(),
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
            )

    def _settings(self) -> dict[str, str]:
        return {
            "MAQUETTE_DATABASE_URL": self.database_url,
            "MAQUETTE_DATA_DIR": str(self.folder / "data"),
            "MAQUETTE_WORKER_PROCESSES": "1",
            "MAQUETTE_STOP_DELAY_S": str(STOP_DELAY_S),
            "OMP_NUM_THREADS": os.environ.get("OMP_NUM_THREADS", "1"),
        }


@contextlib.contextmanager
def running_site(folder: Path, database_url: str) -> Iterator[Site]:
    """A site without processes; what runs at the end is killed."""
    folder.mkdir(parents=True, exist_ok=True)
    site = Site(folder, database_url)
    try:
        yield site
    finally:
        site.end()


def _stopped(process: subprocess.Popen[bytes]) -> int:
    process.send_signal(signal.SIGTERM)
    return process.wait(STOPPED_WITHIN_S)


def _listens(api: Api) -> bool:
    assert api.process.poll() is None, "the API ended at its start"
    with contextlib.suppress(httpx.TransportError):
        return httpx.get(f"{api.address}/healthz/live", timeout=10.0).status_code == 200
    return False


def _free_port() -> int:
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]
