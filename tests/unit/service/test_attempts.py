import time
from dataclasses import fields

import pytest
import sqlalchemy as sa

from api_schemas.jobs import EventKind, JobState
from api_schemas.problems import problem
from api_schemas.results import ResultFile
from service.jobs.attempts import COMPUTED, AttemptLog, checkpoint
from service.jobs.database import open_database
from service.jobs.records import (
    AttemptResult,
    Directive,
    Ending,
    Report,
)
from service.jobs.rows import find_job
from service.jobs.tables import EVENTS, JOBS, METADATA
from tests.stored_jobs import ENDINGS, insert_job

JOB = "00000000-0000-0000-0000-000000000001"
ARTIFACT = ResultFile(name="a.png", media_type="image/png", size=1, sha256="0" * 64)
SUCCESS = AttemptResult(ending=Ending.SUCCEEDED, files=(ARTIFACT,))


@pytest.fixture
def database(tmp_path):
    engine = open_database(f"sqlite:///{tmp_path}/jobs.sqlite")
    METADATA.create_all(engine)
    with engine.begin() as connection:
        insert_job(connection, JOB)
    yield engine
    engine.dispose()


def log(database: sa.Engine, name: str = "worker-1") -> AttemptLog:
    return AttemptLog(
        database,
        executor_id=name,
        max_crashes=3,
        endings=ENDINGS,
        leave_slot=lambda _: None,
    )


def job(database: sa.Engine):
    with database.connect() as connection:
        found = find_job(connection, JOB)
    assert found is not None
    return found


def change(database: sa.Engine, **values: object) -> None:
    with database.begin() as connection:
        connection.execute(sa.update(JOBS).values(**values))


def test_an_attempt_runs_and_ends(database):
    attempt = log(database).begin(JOB)
    assert attempt is not None
    assert attempt.job.attempt == 1
    assert attempt.directive() is Directive.CONTINUE
    ended = log(database).end(JOB, 1, SUCCESS)
    assert ended is not None
    assert ended.state is JobState.SUCCEEDED
    assert ended.progress == 1.0
    assert ended.result_files == (ARTIFACT,)
    assert ended.finished_at is not None


def test_a_job_that_ends_by_a_clock_set_back_does_not_expire_before_its_time(database):
    in_an_hour = time.time() + 3_600.0
    change(database, created_at=in_an_hour)
    log(database).begin(JOB)
    ended = log(database).end(JOB, 1, SUCCESS)
    assert ended is not None
    assert ended.expires_at == pytest.approx(in_an_hour + 60.0)


def test_an_ended_job_is_not_begun_again(database):
    log(database).begin(JOB)
    log(database).end(JOB, 1, SUCCESS)
    assert log(database).begin(JOB) is None
    assert job(database).state is JobState.SUCCEEDED


def test_a_worker_taken_for_dead_can_change_nothing_any_more(database):
    first = log(database).begin(JOB)
    second = log(database, "worker-2").begin(JOB)
    assert first is not None
    assert second is not None
    assert second.job.attempt == 2
    first.report(Report(stage="shading", progress=0.9))
    assert job(database).stage is None
    assert first.directive() is Directive.SUPERSEDED
    log(database).count_crash(first)
    assert log(database).end(JOB, 1, SUCCESS) is None
    assert job(database).state is JobState.RUNNING
    assert log(database, "worker-2").end(JOB, 2, SUCCESS) is not None


def test_a_job_canceled_before_its_attempt_is_ended_not_begun(database):
    change(database, cancel_requested=True)
    assert log(database).begin(JOB) is None
    assert job(database).state is JobState.CANCELED


def test_a_running_attempt_learns_that_it_is_canceled(database):
    attempt = log(database).begin(JOB)
    assert attempt is not None
    change(database, cancel_requested=True)
    assert attempt.directive() is Directive.CANCELED


def test_a_job_that_crashed_three_times_is_given_up(database):
    for number in range(1, 4):
        attempt = log(database).begin(JOB)
        assert attempt is not None
        assert attempt.job.attempt == number
        log(database).count_crash(attempt)
    assert log(database).begin(JOB) is None
    given_up = job(database)
    assert given_up.state is JobState.FAILED
    assert given_up.problem is not None
    assert given_up.problem.type == "/problems/fit-crashed"


def test_progress_never_goes_down_and_every_change_is_an_event(database):
    attempt = log(database).begin(JOB)
    assert attempt is not None
    for share in (0.2, 0.6, 0.4):
        attempt.report(Report(stage="shading", progress=share, energies={"total": share}))
    log(database).end(JOB, 1, SUCCESS)
    with database.connect() as connection:
        events = connection.execute(sa.select(EVENTS).order_by(EVENTS.c.number)).all()
    assert [event.number for event in events] == [1, 2, 3, 4, 5, 6]
    assert [event.kind for event in events] == [
        EventKind.STATE,
        *[EventKind.PROGRESS] * 3,
        EventKind.STATE,
        EventKind.END,
    ]
    assert '"progress":0.6,"energies":{"total":0.4}' in events[3].data


def test_a_job_handed_back_waits_again_and_only_ones_own_are(database):
    attempt = log(database).begin(JOB)
    assert attempt is not None
    log(database, "worker-2").hand_back()
    assert job(database).state is JobState.RUNNING
    log(database).hand_back()
    assert job(database).state is JobState.QUEUED
    assert attempt.directive() is Directive.SUPERSEDED


def test_an_erased_job_supersedes_its_attempt(database):
    attempt = log(database).begin(JOB)
    assert attempt is not None
    with database.begin() as connection:
        connection.execute(sa.delete(JOBS))
    assert attempt.directive() is Directive.SUPERSEDED
    attempt.report(Report(stage="shading", progress=0.5))
    assert log(database).end(JOB, 1, SUCCESS) is None
    with database.connect() as connection:
        assert connection.execute(sa.select(EVENTS)).all() == []


@pytest.mark.parametrize(
    "result",
    [
        SUCCESS,
        AttemptResult(ending=Ending.CANCELED),
        AttemptResult(
            ending=Ending.FAILED,
            problem=problem("fit-failed", detail="Why.", remedy="What.", field="image"),
        ),
    ],
)
def test_a_checkpoint_gives_back_what_it_was_made_from(database, result):
    begun = log(database).begin(JOB)
    stored = COMPUTED.validate_json(checkpoint(begun.job, result))
    assert (stored.attempt, stored.scope) == (1, JOB)
    kept = {each.name: getattr(stored, each.name) for each in fields(AttemptResult)}
    assert AttemptResult(**kept) == result
