"""What a database that is away does to figures, logs and whoever stops a job."""

import contextlib
import threading
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
import sqlalchemy as sa

from service.jobs.database import open_database
from service.jobs.records import FIT, NewJob, StoredBlob
from tests.integration.service.conftest import fresh_machine
from tests.integration.service.database_outage import assert_refused_for_now, no_connections
from tests.integration.service.harness import Machine, running_service
from tests.integration.service.test_images import engine_of
from tests.unit.service.test_database import damage

WRITERS = 60
"""More than the threads in which requests are answered."""

STUCK_S = 60.0
"""A guard against hanging."""


@pytest.fixture
def machine(tmp_path: Path) -> Iterator[Machine]:
    with fresh_machine("postgres", tmp_path) as fresh:
        yield fresh


def test_figures_are_told_while_the_database_is_away(machine: Machine):
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


def test_a_refusal_is_logged_in_a_line_not_in_a_trace(
    machine: Machine, capfd: pytest.CaptureFixture[str]
):
    with running_service(machine, api_only=True) as service, no_connections(machine):
        assert_refused_for_now(service.client.get("/v1/fits"))
    lines = capfd.readouterr().err.splitlines()
    (number,) = [n for n, line in enumerate(lines) if "GET /v1/fits: the database is" in line]
    assert "not currently accepting connections" in lines[number]
    assert lines[number + 1].startswith("20"), "it is followed by another record"


def test_a_database_that_takes_no_writes_answers_questions_and_tells_writers_so(machine: Machine):
    with (
        running_service(machine, api_only=True) as service,
        ThreadPoolExecutor(WRITERS) as posting,
        writes_locked(machine),
    ):
        posted = [posting.submit(service.post) for _ in range(WRITERS)]
        assert service.client.get("/v1/fits").status_code == 200
        for each in posted:
            assert_refused_for_now(each.result())


@contextlib.contextmanager
def writes_locked(machine: Machine) -> Iterator[None]:
    """Hold tables as a migration or a backup may."""
    assert machine.database_url is not None
    database = open_database(machine.database_url, connections=1)
    with database.begin() as connection:
        connection.execute(sa.text("LOCK TABLE maquette_jobs, maquette_erasures IN EXCLUSIVE MODE"))
        yield
    database.dispose()


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
        stopping.join(STUCK_S)
        assert len(answers) == 1
        assert answers[0]


def test_a_damaged_file_is_one_problem_for_everybody_who_asks(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
):
    machine = Machine(tmp_path / "data")
    with running_service(machine, api_only=True) as service:
        damage(machine.data_dir / "maquette.sqlite", "maquette_jobs")
        for path in ("/v1/fits", "/healthz/ready", "/v1/fits", "/v1/images"):
            answer = service.client.get(path)
            assert (answer.status_code, answer.json()["code"]) == (503, "database-damaged")
            assert "copy" in answer.json()["remedy"]
        assert service.client.get("/healthz/live").status_code == 200
    said = capfd.readouterr().err
    assert said.count("The database is damaged") == 1
    assert "Traceback" not in said
