"""The worker's side of the engine on DBOS: claim, run, publish, survive."""

import contextlib
import logging
import os
import threading
import time
import uuid
from typing import Any, Final

import sqlalchemy as sa
from dbos import DBOS, DBOSClient, DBOSPortableJSONSerializer, Queue
from opentelemetry.trace import SpanKind

from api_schemas.body_models import BodyModels
from service.blobs import BlobStore, BlobsUnavailableError
from service.engine.attempts import AttemptLog, result_from_json, result_to_json
from service.engine.dbos_jobs import BODY_MODELS_FACT
from service.engine.facts import write_fact
from service.engine.heartbeat import Heartbeat, executions_table
from service.engine.places import Places
from service.engine.port import AttemptHandler, Ending
from service.engine.queue import APPLICATION, EXECUTION_VERSION, QUEUE, WORKFLOW
from service.logs import fields, log_context
from service.tracing import span

LOG: Final = logging.getLogger(__name__)

MAX_RECOVERIES: Final = 10
"""How many workers may die over one job. Larger than the limit on crashes of the fit's own process,
because a worker dies for reasons that are not the picture's: restarts, machines, chaos tests."""

LOOK_S: Final = 0.01
"""How long DBOS itself pauses between two looks for jobs: what paces it are the places."""

OUTCOME_WAIT_S: Final = 2.0
OUTCOME_POLL_S: Final = 0.02


class DbosWorkerEngine:
    """Runs jobs in this process; see :class:`service.engine.port.WorkerEngine`."""

    def __init__(
        self,
        database: sa.Engine,
        blobs: BlobStore,
        *,
        processes: int,
        max_crashes: int,
        heartbeat_s: float,
        dead_after_s: float,
        queue_poll_s: float,
        retention_s: float,
    ) -> None:
        # Never reused: two live workers under one name would run each other's jobs again.
        self.executor_id = f"{os.uname().nodename[:20]}-{uuid.uuid4().hex}"
        self._database = database
        self._blobs = blobs
        self._queue_poll_s = queue_poll_s
        self._places = Places(processes, poll_s=queue_poll_s)
        self._attempts = AttemptLog(
            database,
            executor_id=self.executor_id,
            max_crashes=max_crashes,
            retention_s=retention_s,
        )
        self._heartbeat = Heartbeat(
            database,
            executor_id=self.executor_id,
            interval_s=heartbeat_s,
            dead_after_s=dead_after_s,
            retention_s=retention_s,
            # Private, but the public resume_workflow forgets how often a job was recovered.
            recover=lambda dead: DBOS._recover_pending_workflows(dead),  # noqa: SLF001
            put_back=lambda job_id: DBOS.resume_workflow(job_id, queue_name=QUEUE),
            holds=self._places.held,
        )
        self._handing_back = threading.Event()
        self._dbos: DBOS | None = None

    def start(self, handler: AttemptHandler, *, body_models: BodyModels) -> None:
        """Begin to claim jobs and run each attempt through ``handler``, in threads of its own."""
        self._dbos = DBOS(
            config={
                "name": APPLICATION,
                "system_database_engine": self._database,
                "serializer": DBOSPortableJSONSerializer(),
                "executor_id": self.executor_id,
                "application_version": EXECUTION_VERSION,
                "run_migrations": False,
                "log_level": "WARNING",
            }
        )
        self._register(handler)
        self._declare_queue()
        self._store_body_models(body_models)
        self._heartbeat.register()
        DBOS.launch()
        self._take_over_pace(self._dbos)
        self._heartbeat.start()

    def stop(self, *, drain_s: float) -> None:
        """Claim no more, wait for running attempts, hand the rest back to other workers.

        Threads of attempts that were handed back are parked, not ended: DBOS would take their
        return for the end of the job. The caller ends the process at once.
        """
        if self._dbos is None:
            return
        for stop in self._dbos.background_thread_stop_events:
            stop.set()
        self._places.close()
        if not self._places.all_left(within_s=drain_s):
            self._handing_back.set()
            self._attempts.hand_back()
        else:
            self._wait_for_outcomes()
        self._heartbeat.stop()

    def _wait_for_outcomes(self) -> None:
        # DBOS notes the end of a workflow after the workflow has returned. Were the process to end
        # in between, another worker would replay the workflow from its checkpoints, in vain.
        executions = executions_table(self._database)
        query = sa.select(sa.func.count()).where(
            executions.c.executor_id == self.executor_id, executions.c.status == "PENDING"
        )
        deadline = time.monotonic() + OUTCOME_WAIT_S
        while time.monotonic() < deadline:
            with self._database.connect() as connection:
                if connection.execute(query).scalar_one() == 0:
                    return
            time.sleep(OUTCOME_POLL_S)

    def _register(self, handler: AttemptHandler) -> None:
        @DBOS.step(name="run")
        def run(job_id: str) -> str | None:
            return self._run(job_id, handler)

        @DBOS.step(name="publish")
        def publish(job_id: str, result: str) -> None:
            self._publish(job_id, result)

        @DBOS.workflow(name=WORKFLOW, max_recovery_attempts=MAX_RECOVERIES)
        def fit(job_id: str) -> None:
            with self._places.taken_by(job_id):
                result = run(job_id)
                if result is not None:
                    publish(job_id, result)

        self._workflow = fit

    def _run(self, job_id: str, handler: AttemptHandler) -> str | None:
        while (attempt := self._attempts.begin(job_id)) is not None:
            started = time.monotonic()
            with (
                log_context(
                    job=job_id, attempt=str(attempt.job.attempt), request=attempt.job.request_id
                ),
                span(
                    attempt.job.kind,
                    parent=attempt.job.traceparent,
                    kind=SpanKind.CONSUMER,
                    attributes={"maquette.job": job_id, "maquette.attempt": attempt.job.attempt},
                ) as current,
            ):
                LOG.info("The %s begins.", attempt.job.kind)
                result = handler(attempt)
                current.set_attribute("maquette.ending", result.ending.value)
                LOG.info(
                    "The %s ended.",
                    attempt.job.kind,
                    extra=fields(ending=result.ending, seconds=f"{time.monotonic() - started:.2f}"),
                )
            if self._handing_back.is_set():
                threading.Event().wait()
            if result.ending is Ending.SUPERSEDED:
                break
            if result.ending is not Ending.CRASHED:
                return result_to_json(attempt.job.attempt, result)
            self._attempts.count_crash(attempt)
        self._erase_if_forgotten(job_id)
        return None

    def _publish(self, job_id: str, text: str) -> None:
        number, result = result_from_json(text)
        self._attempts.end(job_id, number, result)
        self._erase_if_forgotten(job_id)

    def _erase_if_forgotten(self, job_id: str) -> None:
        # The job may have been erased while its attempt was still writing results. Should this not
        # succeed, the scope is among those the sweep erases.
        if not self._attempts.exists(job_id):
            with contextlib.suppress(BlobsUnavailableError):
                self._blobs.erase(job_id)

    def _declare_queue(self) -> None:
        # Before the launch: DBOS looks for new queues only once a second afterwards.
        client = DBOSClient(
            system_database_engine=self._database,
            serializer=DBOSPortableJSONSerializer(),
            application_name=APPLICATION,
        )
        client.register_queue(
            QUEUE,
            worker_concurrency=1,
            polling_interval_sec=self._queue_poll_s,
        )

    def _take_over_pace(self, dbos: DBOS) -> None:
        # DBOS keeps limit and pace in the database, one for all workers, and asks for them before
        # each look for jobs; ours are each machine's own, and it is kept waiting for its turn here.
        # What stands there is the floor, should this private way in ever be gone.
        system_database = dbos._sys_db  # noqa: SLF001
        get_queue = system_database.get_queue

        def get_queue_in_turn(name: str, **options: Any) -> Queue | None:
            if name == QUEUE:
                self._places.await_turn()
            queue = get_queue(name, **options)
            if queue is not None and queue.name == QUEUE:
                queue._worker_concurrency = self._places.count  # noqa: SLF001
                queue._polling_interval_sec = LOOK_S  # noqa: SLF001
            return queue

        system_database.get_queue = get_queue_in_turn

    def _store_body_models(self, body_models: BodyModels) -> None:
        with self._database.begin() as connection:
            write_fact(connection, BODY_MODELS_FACT, body_models.model_dump_json())
