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
from service.jobs.database import open_database
from service.jobs.dbos_jobs import JobEngine
from service.jobs.expiry import expire_jobs
from service.jobs.port import NewJob, StoredBlob, SubmitOutcome
from service.jobs.records import end_job, move_job
from service.jobs.tables import JOBS, TOMBSTONES
from service.jobs.transactions import read_then_write
from tests.integration.service.harness import Machine
from tests.integration.service.test_images import engine_of

TIME_TO_INTERFERE_S = 1.0
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
def interfered_with(read: str, act: Callable[[], Any], *, reading: int = 1) -> Iterator[list[Any]]:
    """Have another thread act as soon as a statement that holds ``read`` was executed.

    It is given time to get through; where it is made to wait, it goes on when it may. Yields what
    it returned, which is there once the block is over.
    """
    done: list[Any] = []
    thread = threading.Thread(target=lambda: done.append(act()))
    readings = 0

    def after(_: object, __: object, statement: str, *___: object) -> None:
        nonlocal readings
        if threading.current_thread() is thread or read not in statement:
            return
        readings += 1
        if readings == reading:
            thread.start()
            thread.join(TIME_TO_INTERFERE_S)

    event.listen(sa.Engine, "after_cursor_execute", after)
    try:
        yield done
    finally:
        event.remove(sa.Engine, "after_cursor_execute", after)
    thread.join()


def accept(jobs: Any, name: str) -> SubmitOutcome:
    jobs.reserve(name, None)
    new = NewJob(id=name, kind="fit", options=BLOB, inputs={})
    return jobs.submit(new).outcome


def fitted(engine: JobEngine, database: sa.Engine, name: str, *, kept_s: float) -> None:
    assert accept(engine.of("ours"), name) is SubmitOutcome.ACCEPTED
    with database.begin() as connection:
        move_job(connection, name, state=JobState.RUNNING, values={"attempt": 1})
        end_job(
            connection, name, state=JobState.SUCCEEDED, retention_s=kept_s, notify=lambda *_: None
        )


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
