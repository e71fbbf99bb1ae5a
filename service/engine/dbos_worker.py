"""The worker's side of the engine on DBOS: claim, run, publish, survive."""

import contextlib
import logging
import os
import threading
import time
import uuid
from collections.abc import Callable
from typing import Final

import sqlalchemy as sa
from dbos import DBOS, DBOSClient, DBOSPortableJSONSerializer
from opentelemetry.trace import SpanKind
from sqlalchemy.exc import SQLAlchemyError

from api_schemas.body_models import BodyModels
from api_schemas.jobs import JobState
from service.blobs import BlobStore, BlobsUnavailableError
from service.engine.attempts import AttemptLog, result_from_json, result_to_json
from service.engine.dbos_internals import (
    pace_queue,
    put_back_executions_of,
    shorten_pauses,
)
from service.engine.dbos_jobs import BODY_MODELS_FACT
from service.engine.executions import Executions
from service.engine.facts import write_fact
from service.engine.heartbeat import Heartbeat
from service.engine.port import AttemptHandler, Ending
from service.engine.queue import APPLICATION, EXECUTION_VERSION, QUEUE, WORKFLOW
from service.engine.tables import JOBS
from service.engine.worker_slots import WorkerSlots
from service.process.disk import Disk
from service.process.logs import fields, log_context
from service.process.tracing import span

LOG: Final = logging.getLogger(__name__)

MAX_RECOVERIES: Final = 10
"""How many workers may die while running one job. Larger than the limit on crashes of the fit's own
process, because workers also die for reasons unrelated to the picture: restarts, machines, chaos
tests."""

LOOK_S: Final = 0.02
"""How long to wait at least between two looks for a job that waits."""

LOOK_ANYWAY_S: Final = 1.0
"""How long DBOS's queue is left alone while no job waits."""

OUTCOME_WAIT_S: Final = 2.0
OUTCOME_POLL_S: Final = 0.02

_ANY_WAITING: Final = sa.select(JOBS.c.id).where(JOBS.c.state == JobState.QUEUED.value).limit(1)


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
        disk: Disk,
        is_able: Callable[[], bool],
    ) -> None:
        # Never reused: two live workers with the same name would rerun each other's jobs.
        self.executor_id = f"{os.uname().nodename[:20]}-{uuid.uuid4().hex}"
        self._database = database
        self._blobs = blobs
        self._queue_poll_s = queue_poll_s
        self._disk = disk
        self._is_able = is_able
        self._is_holding_back = False
        self._slots = WorkerSlots(processes, poll_s=queue_poll_s)
        self._executions = Executions(database)
        self._attempts = AttemptLog(
            database,
            executor_id=self.executor_id,
            max_crashes=max_crashes,
            retention_s=retention_s,
            leave_slot=self._slots.leave,
        )
        self._heartbeat = Heartbeat(
            database,
            executor_id=self.executor_id,
            interval_s=heartbeat_s,
            dead_after_s=dead_after_s,
            retention_s=retention_s,
            executions=self._executions,
            recover=put_back_executions_of,
            put_back=lambda job_id: DBOS.resume_workflow(job_id, queue_name=QUEUE),
            holds=self._slots.held,
            is_able=is_able,
        )
        self._handing_back = threading.Event()
        self._dbos: DBOS | None = None

    def start(
        self,
        handler: AttemptHandler,
        *,
        body_models: BodyModels,
    ) -> None:
        """Begin to claim jobs and run each attempt through ``handler``, in threads of its own.

        While the worker is not able to run any, jobs are left waiting, for this one or another,
        and each heartbeat says so.
        """
        shorten_pauses()
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
        pace_queue(
            self._dbos,
            QUEUE,
            await_turn=self._await_turn,
            usable_slots=lambda: self._usable_slots() if self._is_able() else 0,
        )
        self._heartbeat.start()

    def stop(self, *, drain_s: float) -> None:
        """Claim no more, wait for running attempts, hand the rest back to other workers.

        Threads of attempts that were handed back are parked, not ended: DBOS would take their
        return for the end of the job. The caller must end the process right away.
        """
        if self._dbos is None:
            return
        self._slots.close()
        if not self._slots.all_left(within_s=drain_s):
            self._handing_back.set()
            self._attempts.hand_back()
        else:
            self._wait_for_outcomes()
        self._heartbeat.stop()

    def _wait_for_outcomes(self) -> None:
        # DBOS records the end of a workflow after the workflow has returned. If the process ended
        # in between, another worker would needlessly replay the workflow from its checkpoints.
        deadline = time.monotonic() + OUTCOME_WAIT_S
        while time.monotonic() < deadline:
            if not self._executions.held_by(self.executor_id):
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
            with self._slots.taken_by(job_id):
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
        if self._attempts.end(job_id, number, result) is None:
            self._erase_if_forgotten(job_id)

    def _erase_if_forgotten(self, job_id: str) -> None:
        # The job may have been erased while its attempt was still writing results. If this fails,
        # the scope is still among those the sweep erases.
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

    def _await_turn(self) -> None:
        """Return when a job waits and may be begun, or after a second without any.

        DBOS asks five things whenever it looks. Its queue also holds executions whose job does not
        wait: what dead workers ran, which can wait for a second longer.
        """
        self._slots.end_look()
        deadline = time.monotonic() + LOOK_ANYWAY_S
        while True:
            self._slots.await_turn()
            if self._slots.is_closed:
                # No turn comes any more: the process ends once its jobs have.
                threading.Event().wait()
            if time.monotonic() >= deadline or self._is_any_waiting():
                return
            # Just after a slot was left there is no wait for a turn.
            time.sleep(LOOK_S)

    def _is_any_waiting(self) -> bool:
        try:
            with self._database.connect() as connection:
                return connection.execute(_ANY_WAITING).first() is not None
        except SQLAlchemyError:
            # DBOS meets the same, and pauses.
            return True

    def _usable_slots(self) -> int:
        # Waiting jobs are safe, and running ones need the remaining space for their results.
        is_short = not self._disk.has_room_for()
        if is_short != self._is_holding_back:
            self._is_holding_back = is_short
            if is_short:
                LOG.warning("Too little of the disk is free: no job that waits is begun.")
            else:
                LOG.info("There is room on the disk again: jobs are begun.")
        return 0 if is_short or self._slots.is_closed else self._slots.claimable()

    def _store_body_models(self, body_models: BodyModels) -> None:
        with self._database.begin() as connection:
            write_fact(connection, BODY_MODELS_FACT, body_models.model_dump_json())
