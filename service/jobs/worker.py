"""The worker's side of the engine: claim, run, publish, survive.

The worker claims jobs in their records (:mod:`service.jobs.claims`) when it has a slot for them,
and has DBOS execute each under the job's id. DBOS keeps what the execution has done: when its
worker dies, the next one that claims the job continues it after its last checkpoint.
"""

import contextlib
import logging
import os
import threading
import time
import uuid
from collections.abc import Callable
from functools import partial
from typing import Final

import sqlalchemy as sa
from dbos import DBOS, SetWorkflowID, error

from api_schemas.service import BodyModels
from service.jobs.attempts import (
    COMPUTED,
    AttemptHandler,
    AttemptLog,
    checkpoint,
)
from service.jobs.blobs import BlobStore, BlobsUnavailableError
from service.jobs.claims import Claims
from service.jobs.database import ABSENCES, BODY_MODELS_FACT, write_fact
from service.jobs.executions import (
    FAILED,
    WORKFLOW,
    client_of,
    configure,
    ending,
    queue_of,
)
from service.jobs.heartbeat import Heartbeat
from service.jobs.notices import enqueue_notice
from service.jobs.records import Ending
from service.jobs.rows import Endings
from service.jobs.slots import WorkerSlots
from service.process.data_folder import open_disk
from service.process.logs import fields, log_context
from service.settings import Settings

LOG: Final = logging.getLogger(__name__)

QUEUE_POLL_S: Final = 0.05
"""Interval at which an idle worker looks for jobs, seconds."""

AWAY_PAUSE_S: Final = 1.0
"""Pause while the database is away, seconds."""

CLAIM_ENDS_S: Final = 5.0
"""Time that a worker that stops waits for a claim under way, seconds."""


class WorkerEngine:
    """Runs jobs in this process until told to stop."""

    def __init__(
        self,
        database: sa.Engine,
        blobs: BlobStore,
        settings: Settings,
        *,
        is_able: Callable[[], bool],
    ) -> None:
        # Never reused: two live workers with the same name would rerun each other's jobs.
        self.executor_id = f"{os.uname().nodename[:20]}-{uuid.uuid4().hex}"
        self._database = database
        self._blobs = blobs
        self._disk = open_disk(settings)
        self._is_able = is_able
        self._is_holding_back = False
        self._slots = WorkerSlots(settings.worker_processes, poll_s=QUEUE_POLL_S)
        self._client = client_of(database)
        notify = partial(enqueue_notice, self._client)
        endings = Endings(retention_s=settings.retention_s, notify=notify)
        self._claims = Claims(database, executor_id=self.executor_id, endings=endings)
        self._attempts = AttemptLog(
            database,
            executor_id=self.executor_id,
            max_crashes=settings.max_crashes,
            endings=endings,
            leave_slot=self._slots.leave,
        )
        self._heartbeat = Heartbeat(
            database,
            executor_id=self.executor_id,
            interval_s=settings.heartbeat_s,
            dead_after_s=settings.dead_after_s,
            client=self._client,
            claims=self._claims,
            slots=self._slots,
            is_able=is_able,
        )
        self._handing_back = threading.Event()
        self._claiming = threading.Thread(
            target=self._slots.keep_filled,
            args=(self._begin_waiting_jobs,),
            name="claiming",
            daemon=True,
        )

    def start(self, handler: AttemptHandler, *, body_models: BodyModels) -> None:
        """Begin to claim jobs and run each attempt through ``handler``, in threads of its own.

        While the worker is not able to run any, jobs are left waiting, for this one or another,
        and each heartbeat says so.
        """
        configure(self._database, executor_id=self.executor_id, log_level="WARNING")
        self._register(handler)
        DBOS.listen_queues([queue_of(self.executor_id)])
        with self._database.begin() as connection:
            write_fact(connection, BODY_MODELS_FACT, body_models.model_dump_json())
        self._heartbeat.beat()
        DBOS.launch()
        self._heartbeat.start()
        self._claiming.start()

    def stop(self, *, drain_s: float) -> None:
        """Claim no more, wait for running attempts, hand the rest back to other workers.

        Threads of attempts that were handed back are parked, not ended: DBOS would take their
        return for the end of the job. The caller must end the process right away.
        """
        if not self._claiming.is_alive():
            return
        self._slots.close()
        self._claiming.join(CLAIM_ENDS_S)
        if not self._slots.all_left(within_s=drain_s):
            self._handing_back.set()
            self._attempts.hand_back()
        self._heartbeat.stop()

    def _begin_waiting_jobs(self) -> bool:
        """Begin as many jobs as there are slots for; returns whether any waited."""
        if not self._is_able() or not self._has_disk_space():
            return False
        try:
            jobs = self._claims.take(self._slots.vacant())
        except ABSENCES as absence:
            LOG.warning("The database is not available (%s).", getattr(absence, "orig", absence))
            time.sleep(AWAY_PAUSE_S)
            return False
        for job_id in jobs:
            self._slots.take(job_id)
            try:
                self._execute(job_id)
            except Exception:
                # The heartbeat puts it back.
                LOG.exception(
                    "A job that was claimed could not be begun.", extra=fields(job=job_id)
                )
                self._slots.free(job_id)
        return bool(jobs)

    def _execute(self, job_id: str) -> None:
        """Have DBOS execute a claimed job, or continue what another worker began."""
        try:
            with SetWorkflowID(job_id, workflow_id_reuse_policy="reject"):
                DBOS.start_workflow(self._workflow, job_id)
        except error.DBOSWorkflowIDInUseError:
            self._continue(job_id)

    def _continue(self, job_id: str) -> None:
        ended = ending(self._client, job_id)
        if ended is None:
            DBOS.resume_workflow(job_id, queue_name=queue_of(self.executor_id))
            return
        LOG.error("Job %s was left %s by its execution.", job_id, ended)
        if ended == FAILED:
            self._claims.give_up(job_id)
            self._slots.free(job_id)
        else:
            self._client.delete_workflow(job_id)
            self._execute(job_id)

    def _register(self, handler: AttemptHandler) -> None:
        @DBOS.step(name="run")
        def run(job_id: str) -> str | None:
            return self._run(job_id, handler)

        @DBOS.step(name="publish")
        def publish(job_id: str, result: str) -> None:
            self._publish(job_id, result)

        @DBOS.workflow(name=WORKFLOW)
        def fit(job_id: str) -> None:
            self._slots.begin(job_id)
            try:
                result = run(job_id)
                if result is not None:
                    publish(job_id, result)
            finally:
                self._slots.free(job_id)

        self._workflow = fit

    def _run(self, job_id: str, handler: AttemptHandler) -> str | None:
        scope = job_id
        while (attempt := self._attempts.begin(job_id)) is not None:
            scope = attempt.job.scope
            started = time.monotonic()
            with log_context(
                job=job_id, attempt=str(attempt.job.attempt), request=attempt.job.request_id
            ):
                LOG.info("The %s begins.", attempt.job.kind)
                result = handler(attempt)
                LOG.info(
                    "The %s ended.",
                    attempt.job.kind,
                    extra=fields(ending=result.ending, seconds=f"{time.monotonic() - started:.2f}"),
                )
            self._attempts.await_database()
            if self._handing_back.is_set():
                threading.Event().wait()
            if result.ending is Ending.SUPERSEDED:
                break
            if result.ending is not Ending.CRASHED:
                return checkpoint(attempt.job, result)
            self._attempts.count_crash(attempt)
        self._erase_if_forgotten(scope)
        return None

    def _publish(self, job_id: str, text: str) -> None:
        computed = COMPUTED.validate_json(text)
        if self._attempts.end(job_id, computed.attempt, computed) is None:
            self._erase_if_forgotten(computed.scope)

    def _erase_if_forgotten(self, scope: str) -> None:
        # The fit may have been erased while an attempt was still writing results. If this fails,
        # the scope is still among those the sweep erases.
        if not self._attempts.exists(scope):
            with contextlib.suppress(BlobsUnavailableError):
                self._blobs.erase(scope)

    def _has_disk_space(self) -> bool:
        # Waiting jobs are safe, and running ones need the remaining space for their results.
        is_short = not self._disk.has_room_for()
        if is_short != self._is_holding_back:
            self._is_holding_back = is_short
            if is_short:
                LOG.warning("Too little of the disk is free: no job that waits is begun.")
            else:
                LOG.info("There is room on the disk again: jobs are begun.")
        return not is_short
