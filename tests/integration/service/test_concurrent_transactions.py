"""Transactions that write what follows from what they read, while others write too."""

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest
import sqlalchemy as sa
from sqlalchemy import event

from api_schemas.jobs import JobState
from service.jobs.database import open_database, read_fact, read_then_write, write_fact
from service.jobs.engine import JobEngine
from service.jobs.records import NewJob, StoredBlob, SubmitOutcome
from service.jobs.rows import Endings, move_job
from service.jobs.sweep import expire_jobs
from service.jobs.tables import JOBS, TOMBSTONES
from tests.integration.service.harness import PATIENCE_S, Machine
from tests.integration.service.test_images import engine_of

TIME_TO_INTERFERE_S = 1.0
FACT = "something"
BLOB = StoredBlob(digest="0" * 64, media_type="application/json")


@pytest.fixture
def engine(machine: Machine) -> Iterator[JobEngine]:
    running = engine_of(machine)
    yield running
    running.close()


@pytest.fixture
def database(engine: JobEngine, machine: Machine) -> Iterator[sa.Engine]:
    opened = open_database(
        machine.database_url or f"sqlite:///{machine.data_dir / 'maquette.sqlite'}"
    )
    yield opened
    opened.dispose()


@contextmanager
def interfered_with(read: str, act: Callable[[], Any]) -> Iterator[list[Any]]:
    """Have another thread act as soon as a statement that holds ``read`` was executed.

    It is given time to get through; where it is made to wait, it goes on when it may. Yields what
    it returned, which is there once the block is over.
    """
    done: list[Any] = []
    thread = threading.Thread(target=lambda: done.append(act()))

    def after(_: object, __: object, statement: str, *___: object) -> None:
        if thread.ident is None and read in statement:
            thread.start()
            thread.join(TIME_TO_INTERFERE_S)

    event.listen(sa.Engine, "after_cursor_execute", after)
    try:
        yield done
    finally:
        event.remove(sa.Engine, "after_cursor_execute", after)
    thread.join()


def accept(jobs: Any, name: str) -> SubmitOutcome:
    submissions = jobs.submissions
    submissions.reserve(name, None)
    new = NewJob(id=name, kind="fit", options=BLOB, inputs={})
    return submissions.submit(new).outcome


def fitted(engine: JobEngine, database: sa.Engine, name: str, *, kept_s: float) -> None:
    assert accept(engine.of("ours"), name) is SubmitOutcome.ACCEPTED
    with database.begin() as connection:
        move_job(connection, name, state=JobState.RUNNING, values={"attempt": 1})
        endings = Endings(retention_s=kept_s, notify=lambda *_: None)
        endings.end(connection, name, state=JobState.SUCCEEDED)


def test_a_job_that_two_sweeps_find_expired_is_expired_by_one_of_them(
    engine: JobEngine, database: sa.Engine
):
    def sweep() -> int:
        with read_then_write(database) as connection:
            return expire_jobs(connection, time.time())

    fitted(engine, database, "short", kept_s=0.0)
    with interfered_with(f"SELECT {JOBS.c.id}", sweep) as other:
        assert sweep() == 1
    assert other == [0]
    with database.connect() as connection:
        assert connection.execute(sa.select(TOMBSTONES.c.id)).scalars().all() == ["short"]


def stored(database: sa.Engine) -> str | None:
    with database.connect() as connection:
        return read_fact(connection, FACT)


def test_a_fact_is_written_once_and_again(database: sa.Engine):
    assert stored(database) is None
    for value in ("first", "second"):
        with database.begin() as connection:
            write_fact(connection, FACT, value)
        assert stored(database) == value


def test_of_two_who_write_at_once_none_fails(database: sa.Engine):
    failures: list[Exception] = []

    def write_second() -> None:
        try:
            with database.begin() as connection:
                write_fact(connection, FACT, "second")
        except sa.exc.SQLAlchemyError as error:
            failures.append(error)

    other = threading.Thread(target=write_second)
    with database.begin() as connection:
        write_fact(connection, FACT, "first")
        other.start()
        # It stands before the row that the first has not committed.
        other.join(timeout=0.5)
        assert other.is_alive()
    other.join(timeout=PATIENCE_S)
    assert not failures
    assert stored(database) == "second"
