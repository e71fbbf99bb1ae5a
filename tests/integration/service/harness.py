"""Real processes, real HTTP, real databases: the service with the fake pipeline."""

import contextlib
import json
import os
import re
import signal
import subprocess
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import httpx
import sqlalchemy as sa

from service.compute.fork_server import ForkServer, end
from service.jobs.database import open_database
from service.jobs.tables import JOBS
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.fake_processes import command
from tests.object_storage import variable

PATIENCE_S = 600.0
"""A guard against hanging: passing tests wait for none of it, however crowded the machine."""

REPOSITORY = Path(__file__).parents[3]
CHANGED_PYTHON = Path(__file__).parent / "changed_python"
"""What is first on the path of Pythons that lack a module or whose clock is wrong."""

POINTS = {
    "nose": [320.0, 60.0],
    "left_shoulder": [380.0, 120.0],
    "right_shoulder": [260.0, 120.0],
    "left_hip": [360.0, 260.0],
    "right_hip": [280.0, 260.0],
    "left_knee": [362.0, 350.0],
    "right_knee": [278.0, 350.0],
}
VIEW: Mapping[str, Any] = {"points": POINTS}
REQUEST: dict[str, Any] = {"gender": "male", "height_m": 1.8, "views": [VIEW]}
FRONT_AND_SIDE: dict[str, Any] = {
    "gender": "male",
    "height_m": 1.8,
    "views": [{"view": "front", **VIEW}, {"view": "side", **VIEW}],
}


def said_of_view(**said: object) -> dict[str, Any]:
    """The field of a request that says this of its only picture, beside its points."""
    return {"views": [{**VIEW, **said}]}


QUICK: Mapping[str, object] = {
    "heartbeat_s": 0.2,
    # On one machine the dead are known by the process table, and those who live may be slow.
    "dead_after_s": 60.0,
    "worker_processes": 2,
    "drain_s": 5.0,
    "log_level": "INFO",
}

OWN_SECRET = "whsec_" + "A" * 32
"""By which a service signs notices to those who have named no secret."""

SHARED: Mapping[str, object] = {
    # Notices go to the receivers of tests.
    "webhook_hosts": "127.0.0.1",
    "webhook_secret": OWN_SECRET,
    # It idles while others are tested: every beat looks after all workers and their jobs.
    "heartbeat_s": 1.0,
}
"""What a service that files share is told besides."""


def eventually(
    condition: Callable[[], Any], *, within_s: float = PATIENCE_S, what: str = ""
) -> Any:
    """Wait for a condition and return its value; fail when time is up.

    Asked less and less often: what takes long is not to wait for who asks.
    """
    deadline = time.monotonic() + within_s
    pause_s = 0.02
    while True:
        value = condition()
        if value:
            return value
        assert time.monotonic() < deadline, f"not within {within_s} s: {what or condition}"
        time.sleep(pause_s)
        pause_s = min(1.3 * pause_s, 0.2)


def is_running(pid: int) -> bool:
    """Say whether a process exists and is no zombie."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return False
    return fields[0] != "Z"


def pids_noted(note: Path) -> list[int]:
    """Read the process ids the fake pipeline left behind."""
    return [int(line) for line in note.read_text().split()] if note.exists() else []


@dataclass
class Machine:
    """A data folder and the settings of all processes that share it."""

    data_dir: Path
    database_url: str | None = None
    settings: Mapping[str, object] = field(default_factory=dict)

    def environment(self) -> dict[str, str]:
        values = {"data_dir": self.data_dir, "port": 0, **QUICK, **self.settings}
        if self.database_url is not None:
            values["database_url"] = self.database_url
        variables = dict(map(variable, values.items()))
        inherited = {
            name: value for name, value in os.environ.items() if not name.startswith("MAQUETTE_")
        }
        return inherited | variables

    def start(self, *arguments: str, **options: Any) -> subprocess.Popen[str]:
        """Start one of the service's processes with the fake pipeline."""
        return subprocess.Popen(
            command(*arguments),
            cwd=REPOSITORY,
            env=self.environment(),
            text=True,
            **options,
        )

    def rewrite(self, path: str, **values: object) -> None:
        """Change a job's record behind the service's back, where hours would have to pass."""
        database = open_database(
            self.database_url or f"sqlite:///{self.data_dir / 'maquette.sqlite'}", connections=1
        )
        with database.begin() as connection:
            job = JOBS.c.id == path.rpartition("/")[2]
            assert connection.execute(sa.update(JOBS).where(job).values(values)).rowcount == 1
        database.dispose()


@contextlib.contextmanager
def running_worker(machine: Machine) -> Iterator[subprocess.Popen[str]]:
    """Run a worker of its own; it is killed at the end if it still runs."""
    process = machine.start("worker", stdin=subprocess.PIPE)
    try:
        yield process
    finally:
        if process.poll() is None:
            process.kill()
        process.wait()
        if process.stdin is not None:
            process.stdin.close()


@dataclass
class Service:
    """A running service and a client of it."""

    process: subprocess.Popen[str]
    client: httpx.Client
    machine: Machine

    def post(
        self,
        script: dict[str, object] | None = None,
        *,
        headers: dict[str, str] | None = None,
        request: dict[str, object] | None = None,
    ) -> httpx.Response:
        return self.client.post(
            "/v1/fits",
            files={"image": ("picture.png", scripted_image(script), "image/png")},
            data={"request": json.dumps(request or REQUEST)},
            headers=headers or {},
        )

    def post_several(
        self,
        *scripts: dict[str, object],
        request: Mapping[str, Any] = FRONT_AND_SIDE,
        images: Sequence[bytes] | None = None,
        masks: Sequence[bytes] = (),
        **headers: str,
    ) -> httpx.Response:
        """Post pictures that do what these scripts say, or two that say nothing."""
        if images is None:
            images = [scripted_image(script) for script in scripts or ({}, {"n": 1})]
        files = [("image", ("picture.png", image, "image/png")) for image in images]
        files += [("mask", ("mask.png", mask, "image/png")) for mask in masks]
        return self.client.post(
            "/v1/fits", files=files, data={"request": json.dumps(request)}, headers=headers
        )

    def submit_several(self, *scripts: dict[str, object], **options: Any) -> str:
        """Post so, and return the fit's path."""
        response = self.post_several(*scripts, **options)
        assert response.status_code == 202, response.text
        return response.headers["Location"]

    def submit(self, script: dict[str, object] | None = None) -> str:
        """Post and return the job's path."""
        response = self.post(script)
        assert response.status_code == 202, response.text
        return response.headers["Location"]

    def fitted(self) -> str:
        """Have a fit made, and return its path."""
        path = self.submit()
        assert self.ended(path)["state"] == "succeeded"
        return path

    def job(self, path: str) -> dict[str, Any]:
        return self.client.get(path).raise_for_status().json()

    def state(self, path: str) -> str:
        return self.job(path)["state"]

    def ended(self, path: str, *, within_s: float = PATIENCE_S) -> dict[str, Any]:
        """Wait until the job has ended and return it."""
        active = {"queued", "running"}
        eventually(lambda: self.state(path) not in active, within_s=within_s, what=f"{path} ended")
        return self.job(path)

    def events(self, path: str, *, after: int | None = None) -> list[dict[str, Any]]:
        """Follow the job to its end and return its events."""
        headers = {} if after is None else {"Last-Event-ID": str(after)}
        events: list[dict[str, Any]] = []
        entry: dict[str, Any] = {}
        with self.client.stream("GET", f"{path}/events", headers=headers) as response:
            assert response.headers["content-type"].startswith("text/event-stream")
            for line in response.iter_lines():
                if line:
                    name, _, value = line.partition(": ")
                    entry[name] = json.loads(value) if name == "data" else value
                elif entry:
                    events += [entry] if "data" in entry else []
                    entry = {}
        return events


@contextlib.contextmanager
def running_service(
    machine: Machine, *, api_only: bool = False, estimator: str = "fake", loads: bool = True
) -> Iterator[Service]:
    """Start the service and, unless ``api_only`` or it never ``loads``, wait until it can work.

    A ``broken`` estimator ends as soon as it is started; a ``real`` one is the service's own.
    """
    process = machine.start(
        "serve",
        *(["--no-worker"] if api_only else []),
        *("--estimator", estimator),
        stdout=subprocess.PIPE,
    )
    try:
        assert process.stdout is not None
        found = next(
            found for line in process.stdout if (found := re.search(r"http://\S+:\d+", line))
        )
        with httpx.Client(base_url=found[0], timeout=PATIENCE_S) as client:
            probe = "/healthz/live" if api_only or not loads else "/healthz/ready"
            eventually(lambda: _answers(client, probe), what=probe)
            yield Service(process, client, machine)
    finally:
        if process.poll() is None:
            process.send_signal(signal.SIGTERM)
        process.wait()
        process.stdout.close() if process.stdout else None


def _answers(client: httpx.Client, path: str) -> bool:
    try:
        return client.get(path).status_code == 200
    except httpx.TransportError:
        return False


def started_anew(server: ForkServer) -> ForkServer:
    """End the fork server of the tests' process, of which there is one for all test files.

    The next one loads what is asked for, with the variables of now.
    """
    connection, process = server.start(_tell_server)
    os.kill(connection.recv(), signal.SIGKILL)
    end(connection, process)
    return server


def _tell_server(connection: Connection) -> None:
    connection.send(os.getppid())
