"""The caller's side of the engine on DBOS: jobs of tenants, and the state of the whole service."""

import logging
import threading
import time
from collections.abc import Sequence
from typing import Final

import sqlalchemy as sa
from dbos import DBOSClient, DBOSPortableJSONSerializer

from api_schemas.jobs import JobState
from api_schemas.service import BodyModels
from service.blobs import BlobStore
from service.jobs.admission import Admission
from service.jobs.availability import available
from service.jobs.executions import APPLICATION
from service.jobs.images import TenantImages
from service.jobs.liveness import WORKERS_SEEN, WorkerWatch
from service.jobs.port import EngineStatistics, EngineUnavailableError, WorkerStatus
from service.jobs.statistics import read_durations, read_outcomes
from service.jobs.sweeper import Sweeper
from service.jobs.tables import JOBS
from service.jobs.tenant_jobs import TenantJobs
from service.jobs.transactions import read_fact, touch_fact

LOG: Final = logging.getLogger(__name__)

BODY_MODELS_FACT: Final = "body_models"

# Written out once: it is executed ten times a second while somebody follows a job.
_LAST_EVENTS: Final = sa.select(JOBS.c.id, JOBS.c.last_event).where(
    JOBS.c.id.in_(sa.bindparam("jobs", expanding=True))
)


class JobEngine:
    """The caller's side: jobs and pictures of tenants, and the state of the whole service.

    Every method but those named ``of`` may raise :class:`EngineUnavailableError`.
    ``start`` begins the two background tasks: erasing what has expired, and watching the workers,
    about whom a single look says little.
    """

    def __init__(
        self,
        database: sa.Engine,
        blobs: BlobStore,
        *,
        max_queued: int,
        max_queued_per_tenant: int,
        image_quota: int,
        retention_s: float,
        sweep_interval_s: float,
        heartbeat_s: float,
        dead_after_s: float,
    ) -> None:
        self._database = database
        self._max_queued = max_queued
        self._max_queued_per_tenant = max_queued_per_tenant
        self._image_quota = image_quota
        self._retention_s = retention_s
        self._heartbeat_s = heartbeat_s
        self._client = DBOSClient(
            system_database_engine=database,
            serializer=DBOSPortableJSONSerializer(),
            application_name=APPLICATION,
            # A request is to be refused while the database is away, not to wait until it is back.
            retry_connection_errors=False,
        )
        self._watch = WorkerWatch(dead_after_s=dead_after_s)
        self._sweeper = Sweeper(database, self._client, blobs, interval_s=sweep_interval_s)
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
        return TenantJobs(
            database=self._database,
            client=self._client,
            admission=Admission(
                tenant=tenant,
                max_queued=self._max_queued,
                max_queued_per_tenant=self._max_queued_per_tenant,
            ),
            retention_s=self._retention_s,
        )

    def images_of(self, tenant: str) -> TenantImages:
        """Return the uploaded pictures of a tenant."""
        return TenantImages(
            tenant,
            database=self._database,
            retention_s=self._retention_s,
            quota=self._image_quota,
        )

    @available
    def last_events(self, job_ids: Sequence[str]) -> dict[str, int]:
        """Return the number of the last event of each job that exists."""
        with self._database.connect() as connection:
            rows = connection.execute(_LAST_EVENTS, {"jobs": list(job_ids)})
            return {row.id: row.last_event for row in rows}

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
            rows = connection.execute(WORKERS_SEEN).all()
        return self._watch.look(rows)

    @available
    def statistics(self) -> EngineStatistics:
        """Return statistics of the whole service."""
        with self._database.connect() as connection:
            active = {
                row.state: row
                for row in connection.execute(
                    sa.select(
                        JOBS.c.state,
                        sa.func.count().label("jobs"),
                        sa.func.min(JOBS.c.created_at).label("oldest"),
                    )
                    .where(JOBS.c.state.in_([JobState.QUEUED.value, JobState.RUNNING.value]))
                    .group_by(JOBS.c.state)
                )
            }
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
        while not self._stopped.wait(self._heartbeat_s):
            try:
                self.workers()
            except EngineUnavailableError:
                LOG.warning("The database is not available; nothing is known of the workers.")
            except Exception:
                LOG.exception("Watching the workers failed.")
