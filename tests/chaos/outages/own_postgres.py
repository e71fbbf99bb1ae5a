"""A Postgres server of a run's own, which may be killed."""

import contextlib
import os
import shutil
import signal
import socket
import subprocess
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

from tests.postgres import server_folder

PROGRAMS = Path("/usr/lib/postgresql")
AS_POSTGRES = ("setpriv", "--reuid=postgres", "--regid=postgres", "--clear-groups")
"""The server refuses to be run by root."""

STARTED_WITHIN_S = 120.0
PAUSE_S = 0.5


class OwnPostgres:
    """One cluster in a folder of its own, listening on one address."""

    def __init__(self, folder: Path, *, host: str, options: Sequence[str]) -> None:
        self.url = ""
        self._folder = folder
        self._data = folder / "data"
        self._programs = max(PROGRAMS.iterdir(), key=lambda path: int(path.name)) / "bin"
        with socket.socket() as listener:
            listener.bind((host, 0))
            port = listener.getsockname()[1]
        self._options = [
            f"listen_addresses={host}",
            f"port={port}",
            f"unix_socket_directories={folder}",
            *options,
        ]
        self.url = f"postgresql://postgres@{host}:{port}/postgres"

    @property
    def log(self) -> Path:
        """What the server has to say."""
        return self._folder / "log"

    def make(self, *, reached_from: str) -> None:
        """Make the cluster, which trusts a range of addresses."""
        made = (self._programs / "initdb", "-A", "trust", "-D", self._data)
        self._run(*made, check=True)
        with (self._data / "pg_hba.conf").open("a") as stream:
            stream.write(f"host all all {reached_from} trust\n")

    def start(self) -> None:
        """Start, as often as it takes: after a kill the old processes have to end first."""
        deadline = time.monotonic() + STARTED_WITHIN_S
        while not self.start_once():
            assert time.monotonic() < deadline, self.log.read_text(errors="replace")[-2_000:]
            time.sleep(PAUSE_S)

    def start_once(self) -> bool:
        """Try to start; say whether the server answers."""
        options = " ".join(f"-c {each}" for each in self._options)
        done = self._run(
            self._programs / "pg_ctl",
            "-D",
            self._data,
            "-w",
            "-l",
            self.log,
            "-o",
            options,
            "start",
        )
        return done.returncode == 0

    @property
    def is_running(self) -> bool:
        """Whether there is a postmaster."""
        done = self._run(self._programs / "pg_ctl", "-D", self._data, "status")
        return done.returncode == 0

    def kill(self) -> None:
        """Kill the postmaster with SIGKILL."""
        pid = int((self._data / "postmaster.pid").read_text().split()[0])
        os.kill(pid, signal.SIGKILL)

    def stop(self) -> None:
        """Stop at once."""
        self._run(self._programs / "pg_ctl", "-D", self._data, "-m", "immediate", "stop")

    def _run(self, *command: str | Path, check: bool = False) -> subprocess.CompletedProcess[bytes]:
        return subprocess.run(
            [*AS_POSTGRES, *command],
            check=check,
            cwd=self._folder,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )


@contextlib.contextmanager
def own_postgres(
    *,
    folder: Path | None = None,
    host: str = "127.0.0.1",
    reached_from: str = "127.0.0.1/32",
    options: Sequence[str] = (),
) -> Iterator[OwnPostgres]:
    """Run a server with an empty database; it and its files are gone at the end."""
    made = server_folder() if folder is None else folder
    shutil.chown(made, "postgres", "postgres")
    server = OwnPostgres(made, host=host, options=options)
    try:
        server.make(reached_from=reached_from)
        server.start()
        yield server
    finally:
        server.stop()
        if folder is None:
            shutil.rmtree(made)
