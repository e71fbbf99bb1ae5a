"""The caller's side of the engine: jobs of tenants, and the state of the whole service."""

import logging
import threading
import time
from collections.abc import Sequence
from functools import partial
from typing import Any, Final

import sqlalchemy as sa
from dbos import DBOSClient

from api_schemas.jobs import EventData, EventKind, JobState
from api_schemas.service import BodyModels
from service.jobs.blobs import BlobStore
from service.jobs.database import (
    ABSENCES,
    BODY_MODELS_FACT,
    available,
    read_fact,
    touch_fact,
)
from service.jobs.executions import client_of
from service.jobs.images import TenantImages
from service.jobs.liveness import WorkerWatch
from service.jobs.notices import enqueue_notice
from service.jobs.records import (
    EngineStatistics,
    EngineUnavailableError,
    JobEvent,
    JobExpiredError,
    JobRecord,
    WorkerStatus,
)
from service.jobs.rows import Endings, job_record, job_where, read_durations, read_outcomes
from service.jobs.submit import Submissions, product_of
from service.jobs.sweep import Sweeper, forget_fits, forget_pages, forget_workflows
from service.jobs.tables import EVENTS, JOBS, TOMBSTONES, WORKERS
from service.settings import Settings

LOG: Final = logging.getLogger(__name__)


class TenantJobs:
    """The fits of one tenant and their products; ``submissions`` accepts more.

    Others can be neither seen nor touched through it. Every method may raise
    :class:`EngineUnavailableError`; those that name a fit, but for ``product``, raise
    :class:`JobExpiredError` if it has expired.
    """

    def __init__(
        self,
        tenant: str,
        *,
        database: sa.Engine,
        client: DBOSClient,
        endings: Endings,
        submissions: Submissions,
    ) -> None:
        self._tenant = tenant
        self._database = database
        self._client = client
        self._endings = endings
        self.submissions = submissions

    @available
    def job(self, job_id: str) -> JobRecord | None:
        """Return the fit, or None if there is none."""
        with self._database.connect() as connection:
            return self._find(connection, job_id)

    @available
    def product(self, fit_id: str, product: str) -> JobRecord | None:
        """Return a product of a fit, or None if there is none."""
        with self._database.connect() as connection:
            return job_where(connection, *product_of(self._tenant, fit_id, product))

    @available
    def jobs(
        self,
        *,
        limit: int,
        before: tuple[float, str] | None,
        state: JobState | None,
        label: str | None = None,
    ) -> Sequence[JobRecord]:
        """Return fits newest first; ``before`` is the (created_at, id) of the last one seen.

        With a ``state`` or a ``label`` only those that have it.
        """
        query = (
            sa.select(JOBS)
            .where(
                *self._ours(),
                sa.or_(JOBS.c.expires_at.is_(None), JOBS.c.expires_at > time.time()),
            )
            .order_by(JOBS.c.created_at.desc(), JOBS.c.id.desc())
            .limit(limit)
        )
        if before is not None:
            seen = sa.tuple_(*map(sa.literal, before))
            query = query.where(sa.tuple_(JOBS.c.created_at, JOBS.c.id) < seen)
        if state is not None:
            query = query.where(JOBS.c.state == state.value)
        if label is not None:
            query = query.where(JOBS.c.label == label)
        with self._database.connect() as connection:
            return [job_record(row) for row in connection.execute(query).mappings()]

    @available
    def cancel(self, job_id: str) -> JobRecord | None:
        """Stop a fit: at once if queued, within moments if running; no effect if it has ended.

        If that worker is dead, the next one finds the job, sees the request and ends it.
        """
        with self._database.begin() as connection:
            canceled = self._endings.end(
                connection,
                job_id,
                *self._ours(),
                JOBS.c.state == JobState.QUEUED.value,
                state=JobState.CANCELED,
                values={"cancel_requested": True},
            )
            if canceled is None:
                connection.execute(
                    sa.update(JOBS)
                    .where(*self._own(job_id), JOBS.c.state == JobState.RUNNING.value)
                    .values(cancel_requested=True)
                )
                return self._find(connection, job_id)
        return canceled

    @available
    def erase(self, job_id: str) -> bool:
        """Stop a fit and its products, and forget them; returns whether there was such a fit.

        The caller should erase its scope; if it does not get to it, the sweep will. A running
        attempt finds itself superseded.
        """
        with self._database.begin() as connection:
            forgotten = forget_fits(connection, *self._own(job_id))
            if not forgotten:
                self._find(connection, job_id)
        if forgotten:
            try:
                self._forget_traces([row.id for row in forgotten])
            except ABSENCES as error:
                cause = getattr(error, "orig", error)
                LOG.warning("The sweep comes to what is left of a job (%s).", cause)
        return bool(forgotten)

    def _forget_traces(self, forgotten: Sequence[str]) -> None:
        for job_id in forgotten:
            forget_workflows(self._client, job_id)
        forget_pages(self._database)

    @available
    def events(self, job_id: str, *, after: int) -> Sequence[JobEvent]:
        """Return the events numbered above ``after``."""
        query = (
            sa.select(EVENTS)
            .join(JOBS, JOBS.c.id == EVENTS.c.job_id)
            .where(*self._own(job_id), EVENTS.c.number > after)
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

    def _ours(self) -> tuple[sa.ColumnElement[bool], ...]:
        return (JOBS.c.tenant == self._tenant, JOBS.c.parent_id.is_(None))

    def _own(self, job_id: str) -> tuple[sa.ColumnElement[bool], ...]:
        return (JOBS.c.id == job_id, *self._ours())

    def _find(self, connection: sa.Connection, job_id: str) -> JobRecord | None:
        record = job_where(connection, *self._own(job_id))
        if record is not None:
            if record.expires_at is not None and record.expires_at <= time.time():
                raise JobExpiredError(record.expires_at)
            return record
        expired_at = connection.execute(
            sa.select(TOMBSTONES.c.expired_at).where(
                TOMBSTONES.c.id == job_id, TOMBSTONES.c.tenant == self._tenant
            )
        ).scalar_one_or_none()
        if expired_at is not None:
            raise JobExpiredError(expired_at)
        return None


class JobEngine:
    """Jobs and pictures of tenants, and the state of the whole service.

    Every method but those named ``of`` may raise :class:`EngineUnavailableError`.
    ``start`` begins the two background tasks: erasing what has expired, and watching the workers,
    about whom a single look says little.
    """

    def __init__(
        self,
        database: sa.Engine,
        blobs: BlobStore,
        settings: Settings,
    ) -> None:
        self._database = database
        self._settings = settings
        self._client = client_of(database)
        notify = partial(enqueue_notice, self._client)
        self._endings = Endings(retention_s=settings.retention_s, notify=notify)
        self._watch = WorkerWatch(dead_after_s=settings.dead_after_s)
        interval_s = settings.sweep_interval_s
        self._sweeper = Sweeper(database, self._client, blobs, interval_s=interval_s)
        self._stopped = threading.Event()
        self._watching = threading.Thread(target=self._watch_workers, name="watch", daemon=True)

    def start(self) -> None:
        """Begin to sweep and to watch."""
        self._sweeper.start()
        self._watching.start()

    def close(self) -> None:
        """Stop sweeping and watching, and release the connections."""
        self._stopped.set()
        if self._watching.is_alive():
            self._sweeper.stop()
            self._watching.join()
        self._client.destroy()
        self._database.dispose()

    def of(self, tenant: str) -> TenantJobs:
        """Return the fits of a tenant."""
        submissions = Submissions(tenant, self._database, self._settings)
        return TenantJobs(
            tenant,
            database=self._database,
            client=self._client,
            endings=self._endings,
            submissions=submissions,
        )

    def images_of(self, tenant: str) -> TenantImages:
        """Return the uploaded pictures of a tenant."""
        return TenantImages(tenant, self._database, self._settings)

    @available
    def last_events(self, job_ids: Sequence[str]) -> dict[str, int]:
        """Return the number of the last event of each job that exists."""
        query = sa.select(JOBS.c.id, JOBS.c.last_event).where(JOBS.c.id.in_(job_ids))
        with self._database.connect() as connection:
            return {row.id: row.last_event for row in connection.execute(query)}

    @available
    def queued(self) -> int:
        """Count the waiting jobs."""
        query = sa.select(sa.func.count()).where(JOBS.c.state == JobState.QUEUED.value)
        with self._database.connect() as connection:
            return connection.execute(query).scalar_one()

    @available
    def workers(self) -> Sequence[WorkerStatus]:
        """Return the workers that are known and not known to be gone."""
        with self._database.connect() as connection:
            return self._watch.look(connection.execute(sa.select(WORKERS)).all())

    @available
    def statistics(self) -> EngineStatistics:
        """Return statistics of the whole service."""
        by_state = (
            sa.select(
                JOBS.c.state,
                sa.func.count().label("jobs"),
                sa.func.min(JOBS.c.created_at).label("oldest"),
            )
            .where(JOBS.c.state.in_([JobState.QUEUED.value, JobState.RUNNING.value]))
            .group_by(JOBS.c.state)
        )
        with self._database.connect() as connection:
            active: dict[str, Any] = {row.state: row for row in connection.execute(by_state)}
            outcomes = read_outcomes(connection)
            durations = read_durations(connection)
            crashes = connection.execute(sa.select(sa.func.sum(JOBS.c.crashes))).scalar_one()
        queued = active.get(JobState.QUEUED.value)
        running = active.get(JobState.RUNNING.value)
        return EngineStatistics(
            queued=queued.jobs if queued else 0,
            running=running.jobs if running else 0,
            oldest_queued_s=max(0.0, time.time() - queued.oldest) if queued else 0.0,
            outcomes=outcomes,
            durations=durations,
            crashes=int(crashes or 0),
        )

    @available
    def body_models(self) -> BodyModels | None:
        """Return what the worker that last started can fit; None before any did."""
        with self._database.connect() as connection:
            value = read_fact(connection, BODY_MODELS_FACT)
        return None if value is None else BodyModels.model_validate_json(value)

    @available
    def check_writable(self) -> None:
        """Raise :class:`EngineUnavailableError` if the database cannot be written."""
        with self._database.begin() as connection:
            touch_fact(connection, BODY_MODELS_FACT)

    def _watch_workers(self) -> None:
        while not self._stopped.wait(self._settings.heartbeat_s):
            try:
                self.workers()
            except EngineUnavailableError:
                LOG.warning("The database is not available; nothing is known of the workers.")
            except Exception:
                LOG.exception("Watching the workers failed.")
