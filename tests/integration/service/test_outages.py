"""A disk that is full, a database that is locked or away, a clock that jumps: all is well again."""

import contextlib
import resource
import sqlite3
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from email.utils import parsedate_to_datetime
from pathlib import Path

import httpx
import pytest
import sqlalchemy as sa
from psycopg import sql

from service.jobs.database import open_database
from service.jobs.records import FIT, NewJob, StoredBlob
from tests.integration.service.harness import (
    CHANGED_PYTHON,
    PATIENCE_S,
    Machine,
    Service,
    eventually,
    pids_noted,
    running_service,
)
from tests.integration.service.test_images import engine_of
from tests.postgres import administration
from tests.process_table import processes_with
from tests.unit.service.test_database import damage


@contextlib.contextmanager
def no_connections(machine: Machine) -> Iterator[None]:
    """Close all connections to the machine's own database, and refuse new ones."""
    assert machine.database_url is not None
    name = machine.database_url.rpartition("/")[2]
    allow = sql.SQL("ALTER DATABASE {} WITH ALLOW_CONNECTIONS {}")
    with administration() as connection:
        connection.execute(allow.format(sql.Identifier(name), sql.Literal(False)))
        connection.execute(
            "SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE datname = %s", [name]
        )
        try:
            yield
        finally:
            connection.execute(allow.format(sql.Identifier(name), sql.Literal(True)))


def assert_refused_for_now(answer: httpx.Response) -> None:
    assert answer.status_code == 503, answer.text
    assert answer.headers["Retry-After"]
    assert answer.json()["code"] == "database-unavailable"


OUTAGE_S = 4.0
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
    embedded: Machine, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    clock, note, gate = (tmp_path / name for name in ("clock", "pids", "gate"))
    set_clock(clock, 0.0)
    monkeypatch.setenv("SHIFTED_CLOCK", str(clock))
    monkeypatch.setenv("PYTHONPATH", str(CHANGED_PYTHON), prepend=":")
    jumping = Machine(embedded.data_dir, settings={"sweep_interval_s": 0.1})
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


WRITERS = 60
"""More than the threads in which requests are answered."""


@pytest.mark.parametrize("machine", ["postgres"], indirect=True)
def test_figures_are_told_while_the_database_is_away_and_a_refusal_is_one_line_of_the_log(
    machine: Machine, capfd: pytest.CaptureFixture[str]
):
    with running_service(machine, api_only=True) as service:
        before = service.client.get("/metrics")
        with no_connections(machine):
            assert_refused_for_now(service.client.get("/v1/fits"))
            during = service.client.get("/metrics")
        after = service.client.get("/metrics")
    for answer, is_available in ((before, "1.0"), (during, "0.0"), (after, "1.0")):
        assert answer.status_code == 200
        assert f"\nmaquette_database_available {is_available}\n" in answer.text
    refused = 'maquette_http_requests_total{method="GET",route="/v1/fits",status="503"} 1.0'
    assert refused in during.text
    assert "maquette_workers" not in during.text
    lines = capfd.readouterr().err.splitlines()
    (number,) = [n for n, line in enumerate(lines) if "GET /v1/fits: the database is" in line]
    assert "not currently accepting connections" in lines[number]
    assert lines[number + 1].startswith("20"), "it is followed by another record"


@pytest.mark.parametrize("machine", ["postgres"], indirect=True)
def test_a_database_that_takes_no_writes_answers_questions_and_tells_writers_so(machine: Machine):
    with (
        running_service(machine, api_only=True) as service,
        ThreadPoolExecutor(WRITERS) as posting,
        writes_locked(machine),
    ):
        posted = [posting.submit(service.post) for _ in range(WRITERS)]
        assert service.client.get("/v1/fits").status_code == 200
        # What is refused now may be accepted once the tables are let go.
        assert_refused_for_now(next(as_completed(posted)).result())


@contextlib.contextmanager
def writes_locked(machine: Machine) -> Iterator[None]:
    """Hold tables as a migration or a backup may."""
    assert machine.database_url is not None
    database = open_database(machine.database_url, connections=1)
    with database.begin() as connection:
        connection.execute(sa.text("LOCK TABLE maquette_jobs, maquette_erasures IN EXCLUSIVE MODE"))
        yield
    database.dispose()


@pytest.mark.parametrize("machine", ["postgres"], indirect=True)
def test_erasing_a_job_does_not_wait_for_a_database_that_goes_away_meanwhile(
    machine: Machine, monkeypatch: pytest.MonkeyPatch
):
    with contextlib.ExitStack() as stack:
        jobs = stack.enter_context(contextlib.closing(engine_of(machine))).of("somebody")
        jobs.submissions.reserve("a", None)
        options = StoredBlob(digest="0" * 64, media_type="application/json")
        jobs.submissions.submit(NewJob(id="a", kind=FIT, options=options, inputs={}))
        proceed = jobs._forget_traces

        def go_away_first(of: Sequence[str]) -> None:
            stack.enter_context(no_connections(machine))
            proceed(of)

        monkeypatch.setattr(jobs, "_forget_traces", go_away_first)
        answers: list[object] = []
        stopping = threading.Thread(target=lambda: answers.append(jobs.erase("a")), daemon=True)
        stopping.start()
        stopping.join(PATIENCE_S)
        assert len(answers) == 1
        assert answers[0]


def test_a_damaged_file_is_one_problem_for_everybody_who_asks(
    embedded: Machine, capfd: pytest.CaptureFixture[str]
):
    with running_service(embedded, api_only=True) as service:
        damage(embedded.data_dir / "maquette.sqlite", "maquette_jobs")
        for path in ("/v1/fits", "/healthz/ready", "/v1/fits", "/v1/images"):
            answer = service.client.get(path)
            assert (answer.status_code, answer.json()["code"]) == (503, "database-damaged")
            assert "copy" in answer.json()["remedy"]
        assert service.client.get("/healthz/live").status_code == 200
    said = capfd.readouterr().err
    assert said.count("The database is damaged") == 1
    assert "Traceback" not in said
