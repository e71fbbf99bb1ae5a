"""What service/engine/dbos_internals.py does with DBOS itself, on both databases."""

import logging
import threading
from collections.abc import Iterator

import pytest
import sqlalchemy as sa
from dbos import DBOS, DBOSClient, DBOSPortableJSONSerializer

from service.engine.database import open_database, prepare_database
from service.engine.dbos_internals import pace_queue, put_back_executions_of
from service.engine.executions import Executions
from service.engine.queue import APPLICATION, EXECUTION_VERSION, QUEUE, WORKFLOW
from tests.integration.service.harness import PATIENCE_S, Machine, eventually

EXECUTOR = "here"
POLL_S = 0.02


class Running:
    """DBOS in this process, with jobs that wait to be let go."""

    def __init__(self, database: sa.Engine) -> None:
        self.turns = 0
        self.usable_slots = 0
        self.begun: list[str] = []
        self.gate = threading.Event()
        self.may_look = threading.Event()
        self.may_look.set()
        self.dbos = DBOS(
            config={
                "name": APPLICATION,
                "system_database_engine": database,
                "serializer": DBOSPortableJSONSerializer(),
                "executor_id": EXECUTOR,
                "application_version": EXECUTION_VERSION,
                "run_migrations": False,
                "log_level": "CRITICAL",
            }
        )
        self.client = DBOSClient(
            system_database_engine=database,
            serializer=DBOSPortableJSONSerializer(),
            application_name=APPLICATION,
        )

        self.executions = Executions(database)

        @DBOS.workflow(name=WORKFLOW)
        def wait(job_id: str) -> None:
            self.begun.append(job_id)
            assert self.gate.wait(PATIENCE_S)

        self._workflow = wait
        self.client.register_queue(QUEUE, worker_concurrency=1, polling_interval_sec=POLL_S)
        DBOS.launch()
        pace_queue(self.dbos, QUEUE, await_turn=self._turn, usable_slots=lambda: self.usable_slots)
        self.looked()

    def enqueue(self, *job_ids: str) -> None:
        for job_id in job_ids:
            self.client.enqueue(
                {
                    "workflow_name": WORKFLOW,
                    "queue_name": QUEUE,
                    "workflow_id": job_id,
                    "app_version": EXECUTION_VERSION,
                },
                job_id,
            )

    def looked(self) -> None:
        """Wait until DBOS has looked for jobs once more, from its turn to the next."""
        seen = self.turns
        eventually(lambda: self.turns >= seen + 3, what="DBOS looks for jobs")

    def status(self, job_id: str) -> tuple[str, int]:
        """How an execution stands, and how often it was begun."""
        (found,) = self.client.list_workflows(workflow_ids=[job_id])
        return found.status, found.recovery_attempts or 0

    def begin_again(self, job_id: str) -> None:
        """Let a job that was put back be claimed once more, and both of its threads end."""
        self.usable_slots = 2
        self.gate.set()
        eventually(lambda: self.status(job_id)[0] == "SUCCESS")
        assert self.begun == [job_id, job_id]

    def _turn(self) -> None:
        self.turns += 1
        assert self.may_look.wait(PATIENCE_S)


@pytest.fixture
def running(machine: Machine, monkeypatch: pytest.MonkeyPatch) -> Iterator[Running]:
    # DBOS keeps the stderr of whoever made the first client; a test before may have closed it.
    monkeypatch.setattr(logging.getLogger("dbos"), "handlers", [logging.NullHandler()])
    url = machine.database_url or f"sqlite:///{machine.data_dir / 'maquette.sqlite'}"
    prepare_database(url)
    database = open_database(url)
    started = Running(database)
    yield started
    started.gate.set()
    started.may_look.set()
    DBOS.destroy(destroy_registry=True, workflow_completion_timeout_sec=60)
    database.dispose()


def test_a_process_says_by_itself_when_and_how_many_jobs_are_claimed(running: Running):
    running.enqueue("one", "two", "three")
    running.looked()
    assert running.begun == []
    running.usable_slots = 2
    eventually(lambda: len(running.begun) == 2, what="two of one that is registered")
    running.looked()
    assert running.begun == ["one", "two"]
    running.usable_slots = 0
    running.looked()  # A look that began before may still know of two.
    running.gate.set()
    eventually(lambda: running.status("two")[0] == "SUCCESS")
    running.looked()
    assert running.begun == ["one", "two"]
    running.usable_slots = 1
    eventually(lambda: running.status("three")[0] == "SUCCESS")


def test_executions_of_the_dead_are_put_back_and_stay_counted(running: Running):
    running.usable_slots = 1
    running.enqueue("one")
    eventually(lambda: running.begun == ["one"])
    running.usable_slots = 0
    running.looked()
    _, begun = running.status("one")
    assert begun > 0
    assert running.executions.holders() == {"one": EXECUTOR}
    assert running.executions.held_by(EXECUTOR) == {"one"}
    put_back_executions_of(["somebody", "else"])
    assert running.status("one") == ("PENDING", begun)
    put_back_executions_of(["somebody", EXECUTOR])
    assert running.status("one") == ("ENQUEUED", begun)
    running.begin_again("one")


def test_the_public_way_to_put_back_asks_nobody_and_forgets_the_count(running: Running):
    # Once this fails, put_back_executions_of may do without what is private.
    running.usable_slots = 1
    running.enqueue("one")
    eventually(lambda: running.begun == ["one"])
    running.usable_slots = 0
    running.looked()
    DBOS.resume_workflow("one", queue_name=QUEUE)
    assert running.status("one") == ("ENQUEUED", 0)
    running.begin_again("one")


def test_what_runs_ends_though_no_turn_comes_any_more(running: Running):
    running.usable_slots = 1
    running.enqueue("one", "two")
    eventually(lambda: running.begun == ["one"])
    running.may_look.clear()
    seen = running.turns
    eventually(lambda: running.turns > seen, what="DBOS waits for its turn")
    running.gate.set()
    eventually(lambda: running.status("one")[0] == "SUCCESS")
    assert running.status("two") == ("ENQUEUED", 0)
    assert running.begun == ["one"]
    running.may_look.set()
