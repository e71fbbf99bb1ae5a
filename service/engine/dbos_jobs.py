"""The caller's side of the engine: our records, with DBOS's queue behind them."""

import functools
import time
from collections.abc import Callable, Sequence
from typing import Final, ParamSpec, TypeVar

import sqlalchemy as sa
from dbos import DBOSClient, DBOSPortableJSONSerializer, EnqueueOptions
from sqlalchemy.exc import IntegrityError, OperationalError
from sqlalchemy.exc import TimeoutError as PoolTimeoutError

from api_schemas.body_models import BodyModels
from api_schemas.jobs import EventData, EventKind, JobState
from service.engine.liveness import WorkerWatch
from service.engine.port import (
    EngineUnavailableError,
    JobEvent,
    JobRecord,
    NewJob,
    Submission,
    SubmitOutcome,
)
from service.engine.records import append_event, change_job, find_job, job_record
from service.engine.tables import EVENTS, FACTS, JOBS, WORKERS

APPLICATION: Final = "maquette"
QUEUE: Final = "fits"
WORKFLOW: Final = "fit"
EXECUTION_VERSION: Final = "1"
"""DBOS's application version: names the meaning of checkpoints, not of the code. Raised only when
a stored checkpoint can no longer be continued; workers run jobs of their own version alone."""

BODY_MODELS_FACT: Final = "body_models"


P = ParamSpec("P")
T = TypeVar("T")


def _available(operation: Callable[P, T]) -> Callable[P, T]:
    @functools.wraps(operation)
    def wrapper(*args: P.args, **kwargs: P.kwargs) -> T:
        try:
            return operation(*args, **kwargs)
        except (OperationalError, PoolTimeoutError) as error:
            raise EngineUnavailableError from error

    return wrapper


class DbosJobEngine:
    """Accept, look up, stop and erase jobs; see :class:`service.engine.port.JobEngine`."""

    def __init__(self, database: sa.Engine, *, max_queued: int, dead_after_s: float) -> None:
        self._database = database
        self._max_queued = max_queued
        self._client = DBOSClient(
            system_database_engine=database,
            serializer=DBOSPortableJSONSerializer(),
            application_name=APPLICATION,
        )
        self._watch = WorkerWatch(dead_after_s=dead_after_s)

    def close(self) -> None:
        """Release the connections."""
        self._client.destroy()
        self._database.dispose()

    @_available
    def submit(self, job: NewJob) -> Submission:
        """Write the record and the queue entry in one transaction."""
        try:
            with self._database.begin() as connection:
                repeated = self._repeated(connection, job)
                if repeated is not None:
                    return repeated
                if self._count_queued(connection) >= self._max_queued:
                    return Submission(outcome=SubmitOutcome.QUEUE_FULL, job=None)
                record = self._insert(connection, job)
                options: EnqueueOptions = {
                    "workflow_name": WORKFLOW,
                    "queue_name": QUEUE,
                    "workflow_id": job.id,
                    "app_version": EXECUTION_VERSION,
                }
                self._client.enqueue_in_transaction(connection, options, job.id)
                return Submission(outcome=SubmitOutcome.ACCEPTED, job=record)
        except IntegrityError:
            # Two requests with one new key raced; the other one is stored by now.
            with self._database.begin() as connection:
                repeated = self._repeated(connection, job)
            if repeated is None:
                raise
            return repeated

    @_available
    def job(self, job_id: str) -> JobRecord | None:
        """Return the job, or None if there is none."""
        with self._database.connect() as connection:
            return find_job(connection, job_id)

    @_available
    def jobs(
        self, *, limit: int, before: tuple[float, str] | None, state: JobState | None
    ) -> Sequence[JobRecord]:
        """Return jobs newest first."""
        query = sa.select(JOBS).order_by(JOBS.c.created_at.desc(), JOBS.c.id.desc()).limit(limit)
        if before is not None:
            created_at, job_id = before
            query = query.where(
                sa.or_(
                    JOBS.c.created_at < created_at,
                    sa.and_(JOBS.c.created_at == created_at, JOBS.c.id < job_id),
                )
            )
        if state is not None:
            query = query.where(JOBS.c.state == state.value)
        with self._database.connect() as connection:
            return [job_record(row) for row in connection.execute(query).mappings()]

    @_available
    def cancel(self, job_id: str) -> JobRecord | None:
        """End a queued job at once; ask the worker of a running one to stop.

        A running job keeps its place in DBOS: if its worker is dead, the next one must find the
        job, see the request and end it.
        """
        with self._database.begin() as connection:
            canceled = change_job(
                connection,
                job_id,
                JOBS.c.state == JobState.QUEUED.value,
                state=JobState.CANCELED,
                values={"cancel_requested": True},
            )
            if canceled is None:
                connection.execute(
                    sa.update(JOBS)
                    .where(JOBS.c.id == job_id, JOBS.c.state == JobState.RUNNING.value)
                    .values(cancel_requested=True)
                )
                return find_job(connection, job_id)
        self._client.cancel_workflow(job_id)
        return canceled

    @_available
    def erase(self, job_id: str) -> bool:
        """Delete record, events and queue entry; a running attempt finds itself superseded."""
        with self._database.begin() as connection:
            found = connection.execute(sa.delete(JOBS).where(JOBS.c.id == job_id)).rowcount > 0
        if found:
            self._client.cancel_workflow(job_id)
            self._client.delete_workflow(job_id)
            self._forget_pages()
        return found

    @_available
    def events(self, job_id: str, *, after: int) -> Sequence[JobEvent]:
        """Return the events numbered above ``after``."""
        query = (
            sa.select(EVENTS)
            .where(EVENTS.c.job_id == job_id, EVENTS.c.number > after)
            .order_by(EVENTS.c.number)
        )
        with self._database.connect() as connection:
            return [
                JobEvent(
                    number=row.number,
                    kind=EventKind(row.kind),
                    data=EventData.model_validate_json(row.data),
                )
                for row in connection.execute(query)
            ]

    @_available
    def last_events(self, job_ids: Sequence[str]) -> dict[str, int]:
        """Return the number of the last event of each job that exists."""
        query = sa.select(JOBS.c.id, JOBS.c.last_event).where(JOBS.c.id.in_(job_ids))
        with self._database.connect() as connection:
            return {row.id: row.last_event for row in connection.execute(query)}

    @_available
    def queued(self) -> int:
        """Count the waiting jobs."""
        with self._database.connect() as connection:
            return self._count_queued(connection)

    @_available
    def live_workers(self) -> int:
        """Count the workers that are alive."""
        with self._database.connect() as connection:
            rows = connection.execute(sa.select(WORKERS)).all()
        return len(self._watch.alive(rows))

    @_available
    def body_models(self) -> BodyModels | None:
        """Return what the worker that last started can fit; None before any did."""
        query = sa.select(FACTS.c.value).where(FACTS.c.name == BODY_MODELS_FACT)
        with self._database.connect() as connection:
            value = connection.execute(query).scalar_one_or_none()
        return None if value is None else BodyModels.model_validate_json(value)

    @_available
    def check_writable(self) -> None:
        """Raise :class:`EngineUnavailableError` if the database cannot be written."""
        with self._database.begin() as connection:
            connection.execute(
                sa.update(FACTS).where(FACTS.c.name == BODY_MODELS_FACT).values(name=FACTS.c.name)
            )

    def _repeated(self, connection: sa.Connection, job: NewJob) -> Submission | None:
        if job.idempotency is None:
            return None
        row = (
            connection.execute(sa.select(JOBS).where(JOBS.c.idempotency_key == job.idempotency.key))
            .mappings()
            .one_or_none()
        )
        if row is None:
            return None
        earlier = job_record(row)
        if earlier.fingerprint != job.idempotency.fingerprint:
            return Submission(outcome=SubmitOutcome.KEY_REUSED, job=None)
        return Submission(outcome=SubmitOutcome.REPEATED, job=earlier)

    def _insert(self, connection: sa.Connection, job: NewJob) -> JobRecord:
        row = (
            connection.execute(
                sa.insert(JOBS)
                .values(
                    id=job.id,
                    state=JobState.QUEUED.value,
                    progress=0.0,
                    attempt=0,
                    crashes=0,
                    cancel_requested=False,
                    created_at=time.time(),
                    options=job.options,
                    image_digest=job.image.digest,
                    image_media_type=job.image.media_type,
                    mask_digest=job.mask.digest if job.mask else None,
                    mask_media_type=job.mask.media_type if job.mask else None,
                    artifacts="[]",
                    idempotency_key=job.idempotency.key if job.idempotency else None,
                    fingerprint=job.idempotency.fingerprint if job.idempotency else None,
                    last_event=1,
                )
                .returning(JOBS)
            )
            .mappings()
            .one()
        )
        record = job_record(row)
        append_event(connection, record, EventKind.STATE)
        return record

    def _count_queued(self, connection: sa.Connection) -> int:
        query = sa.select(sa.func.count()).where(JOBS.c.state == JobState.QUEUED.value)
        return connection.execute(query).scalar_one()

    def _forget_pages(self) -> None:
        # Erased content also stands in the write-ahead log, and the file does not shrink by itself.
        if self._database.dialect.name != "sqlite":
            return
        with self._database.connect() as connection:
            connection.execute(sa.text("PRAGMA incremental_vacuum"))
            connection.execute(sa.text("PRAGMA wal_checkpoint(TRUNCATE)"))
