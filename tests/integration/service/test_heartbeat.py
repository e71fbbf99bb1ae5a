"""What a heartbeat puts back, and what only waits because the database is away."""

import contextlib
import threading
import time
from collections.abc import Iterator
from typing import Any

import pytest
import sqlalchemy as sa
from sqlalchemy import event
from sqlalchemy.exc import OperationalError

from service.engine import heartbeat
from service.engine.claims import Claims
from service.engine.database import open_database, prepare_database
from service.engine.executions import Executions
from service.engine.heartbeat import Heartbeat
from service.engine.worker_slots import WorkerSlots
from tests.integration.service.harness import Machine, eventually
from tests.stored_jobs import insert_job

DROPPED_AFTER_S = 1.0
BEATS_S = 0.3
"""Longer than several beats, and shorter than what is dropped is left."""

AWAY = OperationalError("SELECT 1", {}, ConnectionError("The server is away."))


class Worker:
    """A worker that has claimed a job which has not begun, and its heartbeat."""

    def __init__(self, database: sa.Engine) -> None:
        self.database = database
        with database.begin() as connection:
            insert_job(connection, "job", turn=1)
        self.claims = Claims(database, executor_id="worker", retention_s=60.0)
        self.slots = WorkerSlots(1, poll_s=0.1)
        self.heartbeat = Heartbeat(
            database,
            executor_id="worker",
            interval_s=0.02,
            dead_after_s=60.0,
            claims=self.claims,
            executions=Executions(database),
            slots=self.slots,
            is_able=lambda: True,
        )
        self.heartbeat.register()
        assert self.claims.take(1) == ["job"]
        self.slots.take("job")
        self.heartbeat.start()

    @contextlib.contextmanager
    def no_database(self) -> Iterator[None]:
        """Refuse every statement, as while the server is away."""
        refused = threading.Event()

        def refuse(*_: Any) -> None:
            refused.set()
            raise AWAY

        event.listen(self.database, "before_cursor_execute", refuse)
        try:
            assert refused.wait(60.0)
            yield
        finally:
            event.remove(self.database, "before_cursor_execute", refuse)


@pytest.fixture
def worker(embedded: Machine, monkeypatch: pytest.MonkeyPatch) -> Iterator[Worker]:
    monkeypatch.setattr(heartbeat, "DROPPED_AFTER_S", DROPPED_AFTER_S)
    url = f"sqlite:///{embedded.data_dir / 'maquette.sqlite'}"
    prepare_database(url)
    database = open_database(url)
    worker = Worker(database)
    yield worker
    worker.heartbeat.stop()
    database.dispose()


def test_a_job_that_does_not_begin_is_put_back(worker: Worker):
    eventually(lambda: not worker.claims.held(), what="the job is put back")
    assert worker.slots.held() == ()


def test_a_job_that_could_not_begin_while_the_database_was_away_is_kept(worker: Worker):
    time.sleep(BEATS_S)
    with worker.no_database():
        time.sleep(1.5 * DROPPED_AFTER_S)
    time.sleep(BEATS_S)
    assert worker.claims.held() == {"job"}
    worker.slots.begin("job")
    time.sleep(1.5 * DROPPED_AFTER_S)
    assert worker.claims.held() == {"job"}
