"""Processes that decode pictures, of a real service: what they know and may do."""

import json
import os
import re
import time
from collections.abc import Iterator
from pathlib import Path

import httpx

from service.demo_data.sample import load_sample
from service.process.confinement import NEEDED
from service.settings import PREFIX

REPOSITORY = Path(__file__).parents[2]
FORK_SERVER = b"multiprocessing.forkserver"
WORKER = b"-m\0service.compute\0"
BEGINS_WITHIN_S = 600.0


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
    deadline = time.monotonic() + BEGINS_WITHIN_S
    while not service.get(path).json()["progress"]:
        assert time.monotonic() < deadline
        time.sleep(0.1)
    # One of a job before it may wait there for another.
    jobs = [each for each in forked() if name_of(each) == "job"]
    assert jobs
    for each in jobs:
        assert_confined(each)
    service.post(f"{path}/cancel").raise_for_status()
