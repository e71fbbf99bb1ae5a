"""What a heartbeat puts back, and what only waits because the database is away."""

import contextlib
import threading
from collections.abc import Iterator
from typing import Any

import pytest
import sqlalchemy as sa
from sqlalchemy import event
from sqlalchemy.exc import OperationalError, SQLAlchemyError
from sqlalchemy.exc import TimeoutError as PoolTimeoutError

from service.jobs.claims import Claims
from service.jobs.database import open_database, prepare_database
from service.jobs.executions import (
    EXECUTION_VERSION,
    WORKFLOW,
    client_of,
    ending,
    holders,
    queue_of,
)
from service.jobs.heartbeat import DROPPED_AFTER_S, Heartbeat
from service.jobs.slots import WorkerSlots
from tests.integration.service.harness import PATIENCE_S, Machine, eventually
from tests.stored_jobs import ENDINGS, insert_job

AWAY = OperationalError("SELECT 1", {}, ConnectionError("The server is away."))
NOBODY = "postgresql://postgres@127.0.0.1:1/none"
NO_CONNECTION = PoolTimeoutError("QueuePool limit of size 8 overflow 0 reached")


class Worker:
    """A worker that has claimed a job which has not begun, and its heartbeat.

    Time is what ``now_s`` says.
    """

    def __init__(self, database: sa.Engine) -> None:
        self.database = database
        self.now_s = 0.0
        self.beats = 0
        with database.begin() as connection:
            insert_job(connection, "job", turn=1)
        self.claims = Claims(database, executor_id="worker", endings=ENDINGS)
        self.slots = WorkerSlots(1, poll_s=0.1)
        self.heartbeat = Heartbeat(
            database,
            executor_id="worker",
            interval_s=0.02,
            dead_after_s=60.0,
            claims=self.claims,
            client=client_of(database),
            slots=self.slots,
            is_able=self._count,
            monotonic=lambda: self.now_s,
        )
        self.heartbeat.beat()
        assert self.claims.take(1) == ["job"]
        self.slots.take("job")
        self.heartbeat.start()

    def _count(self) -> bool:
        self.beats += 1
        return True

    def beat(self) -> None:
        """Wait until all has been done once that a heartbeat does."""
        before = self.beats
        eventually(lambda: self.beats >= before + 2, what="a whole heartbeat")

    @contextlib.contextmanager
    def no_database(self, fault: SQLAlchemyError) -> Iterator[None]:
        """Refuse every statement, as while the server is away."""
        refused = threading.Event()

        def refuse(*_: Any) -> None:
            refused.set()
            raise fault

        event.listen(self.database, "before_cursor_execute", refuse)
        try:
            assert refused.wait(60.0)
            yield
        finally:
            event.remove(self.database, "before_cursor_execute", refuse)


@pytest.fixture
def worker(embedded: Machine) -> Iterator[Worker]:
    url = f"sqlite:///{embedded.data_dir / 'maquette.sqlite'}"
    prepare_database(url)
    database = open_database(url)
    worker = Worker(database)
    yield worker
    worker.heartbeat.stop()
    database.dispose()


def test_a_job_that_does_not_begin_is_put_back(worker: Worker):
    worker.beat()
    assert worker.claims.held() == {"job"}
    worker.now_s = DROPPED_AFTER_S
    worker.beat()
    assert not worker.claims.held()
    assert worker.slots.held() == ()


@pytest.mark.parametrize("fault", [AWAY, NO_CONNECTION], ids=["refused", "no connection free"])
def test_a_job_that_could_not_begin_while_the_database_was_away_is_kept(
    worker: Worker, fault: SQLAlchemyError
):
    worker.beat()
    with worker.no_database(fault):
        worker.now_s = 2.0 * DROPPED_AFTER_S
    worker.beat()
    assert worker.claims.held() == {"job"}
    worker.slots.begin("job")
    worker.now_s = 4.0 * DROPPED_AFTER_S
    worker.beat()
    assert worker.claims.held() == {"job"}


@pytest.fixture
def database(machine: Machine) -> Iterator[sa.Engine]:
    url = machine.database_url or f"sqlite:///{machine.data_dir / 'maquette.sqlite'}"
    prepare_database(url)
    opened = open_database(url)
    yield opened
    opened.dispose()


def test_ended_and_waiting_executions_are_told_apart(database: sa.Engine):
    client = client_of(database)
    for job_id in ("waiting", "canceled", "another"):
        client.enqueue(
            {
                "workflow_name": WORKFLOW,
                "queue_name": queue_of("somebody"),
                "workflow_id": job_id,
                "app_version": EXECUTION_VERSION,
            },
            job_id,
        )
    client.cancel_workflow("canceled")
    client.cancel_workflow("another")
    assert ending(client, "canceled") == "CANCELLED"
    assert ending(client, "waiting") is None
    assert ending(client, "unknown") is None
    assert holders(client) == {}
    client.delete_workflows(["waiting", "canceled"])
    assert ending(client, "canceled") is None
    assert ending(client, "another") == "CANCELLED"


def test_a_database_that_is_away_is_told_and_not_waited_for():
    client = client_of(open_database(NOBODY))
    told: list[OperationalError] = []

    def look() -> None:
        with pytest.raises(OperationalError) as caught:
            holders(client)
        told.append(caught.value)

    looking = threading.Thread(target=look, daemon=True)
    looking.start()
    looking.join(PATIENCE_S)
    assert told
