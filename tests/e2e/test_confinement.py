"""Processes of a real service: what they know, may do, and never run."""

import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from service.demo_data.sample import load_sample
from service.process.confinement import NEEDED
from service.settings import PREFIX
from tests.e2e.service import FIT_WITHIN_S, started_service, wait_for_estimator
from tests.integration.service.harness import eventually

REPOSITORY = Path(__file__).parents[2]
FORK_SERVER = b"multiprocessing.forkserver"
WORKER = b"-m\0service.compute\0"


def forked() -> Iterator[Path]:
    """The fork servers of this checkout's workers that run, and what they have forked."""
    for process in Path("/proc").glob("[0-9]*"):
        try:
            command = (process / "cmdline").read_bytes()
            if FORK_SERVER in command and os.fsencode(REPOSITORY) in command:
                (process / "environ").read_bytes()
                parent = parent_of(process)
                if any(WORKER in command_of(each) for each in (parent, parent_of(parent))):
                    yield process
        except OSError:
            # It has just ended, or is another user's.
            continue


def name_of(process: Path) -> str:
    return (process / "comm").read_text().strip()


def parent_of(process: Path) -> Path:
    (number,) = re.findall(r"^PPid:\t(\d+)$", (process / "status").read_text(), re.MULTILINE)
    return Path("/proc") / number


def command_of(process: Path) -> bytes:
    try:
        return (process / "cmdline").read_bytes()
    except OSError:
        return b""


def variables_of(process: Path) -> list[str]:
    return (process / "environ").read_text().split("\0")


def assert_confined(process: Path) -> None:
    names = {each.partition("=")[0] for each in variables_of(process)}
    assert {name for name in names if name.startswith(PREFIX)} <= NEEDED
    assert f"{PREFIX}PORT" not in names
    status = (process / "status").read_text()
    assert "NoNewPrivs:\t1" in status
    if name_of(process) in ("job", "estimator"):
        # A filter of its calls.
        assert "Seccomp:\t2" in status


def test_they_know_no_secrets_and_gain_no_privileges(service: httpx.Client, finished_fit: str):
    service.get(f"/v1/fits/{finished_fit}").raise_for_status()
    processes = list(forked())
    assert "estimator" in {name_of(each) for each in processes}
    for process in processes:
        assert_confined(process)


def test_they_may_not_write_where_the_api_asks_its_questions(service: httpx.Client):
    service.get("/healthz/live").raise_for_status()
    # Another test's service may be starting beside this one.
    asked = {
        Path(os.fsdecode(command.split(b"\0")[-2]))
        for process in Path("/proc").glob("[0-9]*")
        if WORKER in (command := command_of(process)) and os.fsencode(REPOSITORY) in command
    }
    sockets = {each for each in asked if each.is_socket()}
    assert sockets
    assert all(each.parent.stat().st_mode & 0o077 == 0 for each in sockets)
    written = {
        each.partition("=")[2]
        for process in forked()
        for each in variables_of(process)
        if each.startswith("TMPDIR=")
    }
    assert written
    assert not written & {str(folder) for each in sockets for folder in each.parents}


def test_no_more_does_a_job_that_runs(service: httpx.Client):
    sample = load_sample()
    # The simplex takes minutes: the job lives until it is canceled.
    asked = json.loads(sample.request) | {"optimizer": "simplex"}
    files = {
        "image": ("sample.jpg", sample.image, "image/jpeg"),
        "request": ("request.json", json.dumps(asked), "application/json"),
    }
    path = service.post("/v1/fits", files=files).raise_for_status().headers["Location"]
    eventually(lambda: service.get(path).json()["progress"], what="the fit runs")
    # One of a job before it may wait there for another.
    jobs = [each for each in forked() if name_of(each) == "job"]
    assert jobs
    for each in jobs:
        assert_confined(each)
    service.post(f"{path}/cancel").raise_for_status()


MAQUETTE = Path(sys.executable).with_name("maquette")
NAMES = ("fitter", "http", "json", "logging", "numpy", "selectors", "service", "signal", "socket")
"""Modules that processes of ours import, of ours, of others and of Python."""

STOPPED_WITHIN_S = 600.0

LEAVES_A_MARK = """
from pathlib import Path
with Path({mark!r}).open("a") as mark:
    print(__file__, file=mark)
"""
LISTS_ITSELF = """
import sys
with open({processes!r}, "a") as processes:
    print(*sys.orig_argv, file=processes)
"""

pytestmark = pytest.mark.skipif(
    not MAQUETTE.exists(), reason="maquette is not installed: run `make test`"
)


class Folder:
    """A folder full of modules, of which each leaves a mark when it is run.

    Every process started with its ``environment`` adds its command to ``processes``, by a module on
    PYTHONPATH.
    """

    def __init__(self, place: Path) -> None:
        self.path = place / "current"
        self.path.mkdir()
        self.mark = place / "mark"
        for name in NAMES:
            (self.path / f"{name}.py").write_text(LEAVES_A_MARK.format(mark=str(self.mark)))
        # Numba would read where it finds compiled code, and run it.
        (self.path / ".numba_config.yaml").write_text("cache_dir: kernels\n")
        self.processes = place / "processes"
        chosen = place / "chosen"
        chosen.mkdir()
        (chosen / "sitecustomize.py").write_text(LISTS_ITSELF.format(processes=str(self.processes)))
        path = [str(chosen), *filter(None, [os.environ.get("PYTHONPATH")])]
        inherited = {name: value for name, value in os.environ.items() if "MAQUETTE_" not in name}
        self.environment = inherited | {"PYTHONPATH": os.pathsep.join(path)}

    def left(self) -> list[str]:
        """The files in it that were not there at first."""
        return sorted(
            path.name for path in self.path.iterdir() if path.suffix not in {".py", ".yaml"}
        )


@pytest.fixture
def folder(tmp_path: Path) -> Folder:
    return Folder(tmp_path)


def test_the_folders_modules_are_run_where_they_are_looked_for(folder: Folder):
    command = [sys.executable, "-m", "json.tool", "--help"]
    subprocess.run(command, cwd=folder.path, capture_output=True, check=False)
    assert folder.mark.exists()


def test_neither_api_nor_worker_nor_their_forks_run_what_lies_there(folder: Folder):
    done = subprocess.run(
        [MAQUETTE, "demo", "--output", "demo-output"],
        cwd=folder.path,
        env=folder.environment,
        capture_output=True,
        text=True,
        timeout=FIT_WITHIN_S,
        check=False,
    )
    assert not folder.mark.exists(), folder.mark.read_text()
    assert done.returncode == 0, done.stdout + done.stderr
    assert folder.left() == ["demo-output"]
    started = folder.processes.read_text()
    for process in (
        f"{MAQUETTE} demo",
        "-m service.cli serve",
        "-m service.compute",
        "multiprocessing.forkserver",
        "multiprocessing.resource_tracker",
    ):
        assert process in started


def test_an_api_alone_and_its_estimator_run_nothing_either(folder: Folder):
    command = [str(MAQUETTE), "serve", "--no-worker", "--port", "0"]
    with started_service(command, cwd=folder.path, environment=folder.environment) as client:
        wait_for_estimator(client)
        image = {"image": ("sample.jpg", load_sample().image, "image/jpeg")}
        answer = client.post("/v1/points", files=image)
    assert not folder.mark.exists(), folder.mark.read_text()
    assert answer.status_code == 200, answer.text
    assert folder.left() == ["maquette-data"]
    assert "-m service.compute questions" in folder.processes.read_text()
