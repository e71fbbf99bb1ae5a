"""Who runs which job, and what a heartbeat puts back."""

import contextlib
import threading
from collections.abc import Iterator
from typing import Any

import pytest
import sqlalchemy as sa
from sqlalchemy import event
from sqlalchemy.exc import OperationalError, SQLAlchemyError
from sqlalchemy.exc import TimeoutError as PoolTimeoutError

from api_schemas.jobs import JobState
from service.jobs.attempts import AttemptLog
from service.jobs.claims import MAX_WORKER_DEATHS, Claims
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
from service.jobs.rows import find_job
from service.jobs.slots import WorkerSlots
from service.jobs.tables import JOBS
from tests.integration.service.harness import PATIENCE_S, Machine, eventually
from tests.stored_jobs import ENDINGS, insert_job


@pytest.fixture
def database(machine: Machine) -> Iterator[sa.Engine]:
    url = machine.database_url or f"sqlite:///{machine.data_dir / 'maquette.sqlite'}"
    prepare_database(url)
    opened = open_database(url)
    yield opened
    opened.dispose()


def claims(database: sa.Engine, worker: str) -> Claims:
    return Claims(database, executor_id=worker, endings=ENDINGS)


def attempts(database: sa.Engine, worker: str) -> AttemptLog:
    return AttemptLog(
        database,
        executor_id=worker,
        max_crashes=3,
        endings=ENDINGS,
        leave_slot=lambda _: None,
    )


def accept(database: sa.Engine, name: str, *, turn: int = 1) -> None:
    with database.begin() as connection:
        insert_job(connection, name, turn=turn)


def state(database: sa.Engine, name: str) -> JobState:
    with database.connect() as connection:
        job = find_job(connection, name)
    assert job is not None
    return job.state


def test_jobs_are_claimed_by_their_turn_and_by_one_worker_only(database: sa.Engine):
    for name, turn in {"third": 7, "second": 3, "first": 1}.items():
        accept(database, name, turn=turn)
    one, other = claims(database, "one"), claims(database, "other")
    assert one.take(1) == ["first"]
    assert other.take(5) == ["second", "third"]
    assert one.take(5) == []
    assert (one.held(), other.held()) == ({"first"}, {"second", "third"})
    assert one.holders() == {"one", "other"}


def test_workers_that_claim_at_the_same_time_share_the_jobs(database: sa.Engine):
    names = {f"job-{number}" for number in range(40)}
    for name in names:
        accept(database, name)
    taken: list[str] = []

    def take_all(worker: str) -> None:
        mine = claims(database, worker)
        while jobs := mine.take(2):
            taken.extend(jobs)

    workers = [threading.Thread(target=take_all, args=[f"worker-{each}"]) for each in range(4)]
    for each in workers:
        each.start()
    for each in workers:
        each.join()
    # Postgres skips what another is just claiming; what is left then has not been lost.
    taken.extend(claims(database, "last").take(len(names)))
    assert len(taken) == len(names)
    assert set(taken) == names


def test_a_job_that_ended_or_was_canceled_is_claimed_by_nobody(database: sa.Engine):
    accept(database, "canceled")
    with database.begin() as connection:
        connection.execute(sa.update(JOBS).values(state=JobState.CANCELED.value))
    assert claims(database, "one").take(1) == []


def test_the_jobs_of_the_dead_wait_again_and_are_put_back_once(database: sa.Engine):
    for name in ("begun", "claimed", "others"):
        accept(database, name)
    doomed, other = claims(database, "doomed"), claims(database, "other")
    assert doomed.take(2) == ["begun", "claimed"]
    assert other.take(1) == ["others"]
    assert attempts(database, "doomed").begin("begun") is not None
    assert sorted(other.take_from(["doomed", "somebody"])) == ["begun", "claimed"]
    assert claims(database, "third").take_from(["doomed"]) == []
    assert other.held() == {"others"}
    assert sorted(other.take(5)) == ["begun", "claimed"]
    # It goes on being shown as running, and its next attempt is counted.
    assert state(database, "begun") is JobState.RUNNING
    second = attempts(database, "other").begin("begun")
    assert second is not None
    assert second.job.attempt == 2


def test_a_job_over_which_too_many_workers_died_is_given_up(database: sa.Engine):
    accept(database, "deadly")
    watcher = claims(database, "watcher")
    for number in range(MAX_WORKER_DEATHS + 1):
        assert state(database, "deadly") is not JobState.FAILED
        worker = f"worker-{number}"
        assert claims(database, worker).take(1) == ["deadly"]
        assert attempts(database, worker).begin("deadly") is not None
        watcher.take_from([worker])
    assert state(database, "deadly") is JobState.FAILED
    assert watcher.take(1) == []


def test_workers_that_die_before_a_job_began_do_not_count_against_it(database: sa.Engine):
    accept(database, "job")
    watcher = claims(database, "watcher")
    for number in range(MAX_WORKER_DEATHS + 5):
        worker = f"worker-{number}"
        assert claims(database, worker).take(1) == ["job"]
        watcher.take_from([worker])
    assert state(database, "job") is JobState.QUEUED


def test_a_worker_puts_back_only_what_is_its_own(database: sa.Engine):
    accept(database, "job")
    one, other = claims(database, "one"), claims(database, "other")
    assert one.take(1) == ["job"]
    other.put_back("job")
    assert one.held() == {"job"}
    one.put_back("job")
    assert one.held() == set()
    assert other.take(1) == ["job"]


def test_what_was_claimed_and_not_begun_is_handed_back_too(database: sa.Engine):
    accept(database, "job")
    assert claims(database, "one").take(1) == ["job"]
    attempts(database, "other").hand_back()
    assert claims(database, "other").take(1) == []
    attempts(database, "one").hand_back()
    assert claims(database, "other").take(1) == ["job"]


def test_a_job_whose_execution_failed_is_ended(database: sa.Engine):
    accept(database, "job")
    one = claims(database, "one")
    assert one.take(1) == ["job"]
    one.give_up("job")
    assert state(database, "job") is JobState.FAILED
    assert one.held() == set()


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
            assert refused.wait(PATIENCE_S)
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
