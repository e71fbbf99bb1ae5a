"""A disk that is full, a database that is locked or away, a clock that jumps: all is well again."""

import contextlib
import resource
import sqlite3
import threading
import time
from collections.abc import Callable, Iterator
from email.utils import parsedate_to_datetime
from pathlib import Path

import httpx
import pytest

from tests.integration.service.database_outage import assert_refused_for_now, no_connections
from tests.integration.service.harness import (
    Machine,
    Service,
    eventually,
    pids_noted,
    running_service,
)
from tests.process_table import processes_with

SHIFTED_CLOCK = Path(__file__).parent / "shifted_clock"
OUTAGE_S = 10.0
WHILE_S = 1.0
"""Time for what must not happen. Nothing is to be done by the end of either."""

BEYOND_RETENTION_S = 30 * 86_400.0


def test_what_is_accepted_survives_a_full_disk(embedded: Machine, tmp_path: Path):
    note, gate, end = tmp_path / "pids", tmp_path / "gate", tmp_path / "end"
    with running_service(embedded) as service:
        path = service.submit({"gate": str(gate), "note_pid": str(note), "note_end": str(end)})
        eventually(lambda: pids_noted(note), what="the fit runs")
        with full_disk(embedded):
            refused = [service.post({"number": number}) for number in range(3)]
            gate.touch()
            eventually(end.exists, what="the fit is done")
            time.sleep(WHILE_S)
        assert {answer.status_code for answer in refused} == {507}
        assert {answer.json()["type"] for answer in refused} == {"/problems/insufficient-storage"}
        assert all(answer.headers["Retry-After"] for answer in refused)
        job = service.ended(path)
        assert (job["state"], job["attempt"]) == ("succeeded", 1)
        assert service.client.get(job["links"]["result"]).status_code == 200
        assert service.ended(service.submit())["state"] == "succeeded"
        assert len(service.client.get("/v1/fits").json()["fits"]) == 2


def test_a_locked_embedded_database_is_waited_for(embedded: Machine, tmp_path: Path):
    note, gate = tmp_path / "pids", tmp_path / "gate"
    with running_service(embedded) as service:
        path = service.submit({"gate": str(gate), "note_pid": str(note)})
        eventually(lambda: pids_noted(note), what="the fit runs")
        with locked(embedded):
            gate.touch()
            posted = in_background(lambda: service.post({"number": 1}))
            time.sleep(OUTAGE_S)
            assert service.client.get(path).status_code == 200
        answer = posted()
        assert answer.status_code == 202
        assert service.ended(path)["attempt"] == 1
        for each in (path, answer.headers["Location"]):
            assert service.ended(each)["state"] == "succeeded"
            assert [event["event"] for event in service.events(each)].count("end") == 1


@pytest.mark.parametrize("machine", ["postgres"], indirect=True)
def test_a_database_server_that_goes_away_is_waited_for(machine: Machine, tmp_path: Path):
    note, gate = tmp_path / "pids", tmp_path / "gate"
    with running_service(machine) as service:
        path = service.submit({"gate": str(gate), "note_pid": str(note)})
        waiting = [service.submit({"number": number}) for number in range(4)]
        eventually(lambda: pids_noted(note), what="the fit runs")
        with no_connections(machine):
            assert_refused_for_now(service.post())
            assert_refused_for_now(service.client.get(path))
            gate.touch()
            time.sleep(OUTAGE_S)
        for each in (path, *waiting):
            job = service.ended(each)
            assert (job["state"], job["attempt"]) == ("succeeded", 1)
            assert [event["event"] for event in service.events(each)].count("end") == 1
        assert service.ended(service.submit())["state"] == "succeeded"


def test_a_clock_that_jumps_erases_nothing_and_kills_nobody(
    machine: Machine, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    clock, note, gate = (tmp_path / name for name in ("clock", "pids", "gate"))
    set_clock(clock, 0.0)
    monkeypatch.setenv("SHIFTED_CLOCK", str(clock))
    monkeypatch.setenv("PYTHONPATH", str(SHIFTED_CLOCK), prepend=":")
    jumping = Machine(
        machine.data_dir,
        database_url=machine.database_url,
        settings={"sweep_interval_s": 0.1},
    )
    with running_service(jumping) as service:
        done = service.submit()
        service.ended(done)
        running = service.submit({"gate": str(gate), "note_pid": str(note)})
        eventually(lambda: pids_noted(note), what="the fit runs")
        for jump in (BEYOND_RETENTION_S, -BEYOND_RETENTION_S, 0.0):
            set_clock(clock, jump)
            # The server renews its date about once a second.
            eventually(lambda jump=jump: abs(clock_ahead_s(service) - jump) < 3_600.0)
            time.sleep(WHILE_S)
        gate.touch()
        for path in (done, running):
            job = service.ended(path)
            assert (job["state"], job["attempt"]) == ("succeeded", 1)
            assert service.client.get(job["links"]["result"]).status_code == 200
        assert service.ended(service.submit())["state"] == "succeeded"


def clock_ahead_s(service: Service) -> float:
    """How far the API's clock is ahead of the true one."""
    told = service.client.get("/healthz/live").headers["Date"]
    return parsedate_to_datetime(told).timestamp() - time.time()


def set_clock(clock: Path, offset_s: float) -> None:
    """Set the clocks, which may be read at any moment."""
    new = clock.with_suffix(".new")
    new.write_text(str(offset_s))
    new.rename(clock)


@contextlib.contextmanager
def full_disk(machine: Machine) -> Iterator[None]:
    """Let none of the service's processes make a file any longer."""
    processes = processes_with("MAQUETTE_DATA_DIR", machine.data_dir)
    limits = {each.pid: resource.prlimit(each.pid, resource.RLIMIT_FSIZE) for each in processes}
    for pid, (_, hard) in limits.items():
        resource.prlimit(pid, resource.RLIMIT_FSIZE, (1, hard))
    try:
        yield
    finally:
        for pid, limit in limits.items():
            with contextlib.suppress(ProcessLookupError):
                resource.prlimit(pid, resource.RLIMIT_FSIZE, limit)


@contextlib.contextmanager
def locked(machine: Machine) -> Iterator[None]:
    """Keep everybody else from writing the embedded database."""
    connection = sqlite3.connect(machine.data_dir / "maquette.sqlite", isolation_level=None)
    connection.execute("PRAGMA busy_timeout=30000")
    connection.execute("BEGIN EXCLUSIVE")
    try:
        yield
    finally:
        connection.rollback()
        connection.close()


def in_background(post: Callable[[], httpx.Response]) -> Callable[[], httpx.Response]:
    """Call in a thread; the function returned waits for the answer."""
    answers: list[httpx.Response] = []
    thread = threading.Thread(target=lambda: answers.append(post()))
    thread.start()

    def answer() -> httpx.Response:
        thread.join()
        return answers[0]

    return answer
