"""The jobs of one tenant, as our records have them."""

import functools
import logging
import time
from collections.abc import Sequence
from typing import Final

import sqlalchemy as sa
from dbos import DBOSClient
from sqlalchemy.exc import IntegrityError

from api_schemas.jobs import EventData, EventKind, JobState
from service.jobs.admission import Admission
from service.jobs.availability import ABSENCES, available
from service.jobs.expiry import (
    ABANDONED_AFTER_S,
    enter_erasures,
    forget_job,
    forget_pages,
    take_out,
)
from service.jobs.notices import Notices, notice_of
from service.jobs.port import (
    Idempotency,
    JobEvent,
    JobExpiredError,
    JobRecord,
    NewJob,
    Submission,
    SubmitOutcome,
)
from service.jobs.products import FitProducts
from service.jobs.records import INPUTS, append_event, end_job, job_record
from service.jobs.tables import EVENTS, JOBS, TOMBSTONES
from service.jobs.transactions import read_then_write
from service.jobs.turns import turn_of_next_job

LOG: Final = logging.getLogger(__name__)


class TenantJobs:
    """The fits of one tenant.

    Others can be neither seen nor touched through it. Every method but ``products`` may raise
    :class:`EngineUnavailableError`; those that name a fit raise :class:`JobExpiredError` if it has
    expired.
    """

    def __init__(
        self,
        *,
        database: sa.Engine,
        client: DBOSClient,
        admission: Admission,
        retention_s: float,
    ) -> None:
        self._tenant = admission.tenant
        self._database = database
        self._client = client
        self._admission = admission
        self._retention_s = retention_s
        self._notices = Notices(database)

    def products(self, fit_id: str) -> FitProducts:
        """Return the products of a fit of this tenant; they are erased with it."""
        return FitProducts(fit_id, database=self._database, admission=self._admission)

    @available
    def reserve(self, job_id: str, idempotency: Idempotency | None) -> Submission:
        """Announce that blobs are about to be stored for a job.

        The outcome is ``ACCEPTED``, but without a job, if they may be. The job's scope is listed
        for erasure until the job is accepted: an hour later it is erased.
        """
        with self._database.begin() as connection:
            answered = self._admission.answered(connection, idempotency)
            if answered is not None:
                return answered
            enter_erasures(connection, [job_id], due_at=time.time() + ABANDONED_AFTER_S)
        return Submission(outcome=SubmitOutcome.ACCEPTED, job=None)

    @available
    def repeated(self, idempotency: Idempotency | None) -> Submission | None:
        """Return the answer to a submission that repeats an earlier key; None if it is new."""
        with self._database.connect() as connection:
            return self._admission.earlier(connection, idempotency)

    @available
    def submit(self, job: NewJob) -> Submission:
        """Accept a job durably, or say why not; its scope must have been reserved.

        Its record is all that a worker needs to find it.
        """
        try:
            with read_then_write(self._database) as connection:
                answered = self._admission.answered(connection, job.idempotency)
                if answered is not None:
                    return answered
                if not take_out(connection, job.id):
                    return Submission(outcome=SubmitOutcome.LOST, job=None)
                turn = turn_of_next_job(connection, tenant=self._tenant, is_product=False)
                record = self._insert(connection, job, turn=turn)
                return Submission(outcome=SubmitOutcome.ACCEPTED, job=record)
        except IntegrityError:
            # Two requests with the same new key raced; the other one is stored by now.
            with self._database.begin() as connection:
                repeated = self._admission.earlier(connection, job.idempotency)
            if repeated is None:
                raise
            return repeated

    @available
    def job(self, job_id: str) -> JobRecord | None:
        """Return the job, or None if there is none."""
        with self._database.connect() as connection:
            return self._find(connection, job_id)

    @available
    def jobs(
        self,
        *,
        limit: int,
        before: tuple[float, str] | None,
        state: JobState | None,
        label: str | None = None,
    ) -> Sequence[JobRecord]:
        """Return jobs newest first; ``before`` is the (created_at, id) of the last one seen.

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
            created_at, job_id = before
            query = query.where(
                sa.or_(
                    JOBS.c.created_at < created_at,
                    sa.and_(JOBS.c.created_at == created_at, JOBS.c.id < job_id),
                )
            )
        if state is not None:
            query = query.where(JOBS.c.state == state.value)
        if label is not None:
            query = query.where(JOBS.c.label == label)
        with self._database.connect() as connection:
            return [job_record(row) for row in connection.execute(query).mappings()]

    @available
    def cancel(self, job_id: str) -> JobRecord | None:
        """Stop a job: at once if queued, within moments if running; no effect if it has ended.

        If that worker is dead, the next one finds the job, sees the request and ends it.
        """
        with self._database.begin() as connection:
            canceled = end_job(
                connection,
                job_id,
                *self._ours(),
                JOBS.c.state == JobState.QUEUED.value,
                state=JobState.CANCELED,
                retention_s=self._retention_s,
                notify=self._notices.enqueue,
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
        forgotten = self._forget(job_id)
        if forgotten:
            try:
                self._forget_traces(forgotten)
            except ABSENCES as error:
                cause = getattr(error, "orig", error)
                LOG.warning("The sweep comes to what is left of a job (%s).", cause)
        return bool(forgotten)

    def _forget(self, job_id: str) -> Sequence[str]:
        with self._database.begin() as connection:
            forgotten = forget_job(connection, job_id, *self._ours())
            if not forgotten:
                self._find(connection, job_id)
        return forgotten

    def _forget_traces(self, forgotten: Sequence[str]) -> None:
        for job in forgotten:
            for each in (job, notice_of(job)):
                self._client.cancel_workflow(each)
                self._client.delete_workflow(each)
        forget_pages(self._database)

    @available
    def events(self, job_id: str, *, after: int) -> Sequence[JobEvent]:
        """Return the events numbered above ``after``."""
        with self._database.connect() as connection:
            return [
                JobEvent(
                    number=row.number,
                    kind=EventKind(row.kind),
                    data=EventData.model_validate_json(row.data),
                )
                for row in connection.execute(self._events, {"job": job_id, "after": after})
            ]

    @functools.cached_property
    def _events(self) -> sa.Select:
        """Put together once: whoever follows a job executes it ten times a fit."""
        return (
            sa.select(EVENTS)
            .join(JOBS, JOBS.c.id == EVENTS.c.job_id)
            .where(
                JOBS.c.id == sa.bindparam("job"),
                *self._ours(),
                EVENTS.c.number > sa.bindparam("after"),
            )
            .order_by(EVENTS.c.number)
        )

    def _ours(self) -> tuple[sa.ColumnElement[bool], ...]:
        return (
            JOBS.c.tenant == self._tenant,
            JOBS.c.parent_id.is_(None),
        )

    def _own(self, job_id: str) -> tuple[sa.ColumnElement[bool], ...]:
        return (JOBS.c.id == job_id, *self._ours())

    def _find(self, connection: sa.Connection, job_id: str) -> JobRecord | None:
        row = connection.execute(sa.select(JOBS).where(*self._own(job_id))).mappings().one_or_none()
        if row is not None:
            record = job_record(row)
            if record.expires_at is not None and record.expires_at <= time.time():
                raise JobExpiredError(record.expires_at)
            return record
        expired_at = connection.execute(
            sa.select(TOMBSTONES.c.expired_at).where(
                TOMBSTONES.c.id == job_id,
                TOMBSTONES.c.tenant == self._tenant,
            )
        ).scalar_one_or_none()
        if expired_at is not None:
            raise JobExpiredError(expired_at)
        return None

    def _insert(self, connection: sa.Connection, job: NewJob, *, turn: int) -> JobRecord:
        again = job.idempotency
        row = (
            connection.execute(
                sa.insert(JOBS)
                .values(
                    id=job.id,
                    tenant=self._tenant,
                    kind=job.kind,
                    pictures=job.pictures,
                    label=job.label,
                    turn=turn,
                    state=JobState.QUEUED.value,
                    progress=0.0,
                    attempt=0,
                    crashes=0,
                    cancel_requested=False,
                    created_at=time.time(),
                    options_digest=job.options.digest,
                    inputs=INPUTS.dump_json(dict(job.inputs)).decode(),
                    files="[]",
                    idempotency_key=None if again is None else again.key,
                    fingerprint=None if again is None else again.fingerprint,
                    request_id=job.request_id,
                    last_event=1,
                    webhook_target=job.webhook.digest if job.webhook else None,
                )
                .returning(JOBS)
            )
            .mappings()
            .one()
        )
        record = job_record(row)
        append_event(connection, record, EventKind.STATE)
        return record
