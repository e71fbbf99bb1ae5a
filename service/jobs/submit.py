"""Accepting jobs: room for one more, repeated requests, and its turn.

Owners take turns, and each owner's jobs are started in their order. An owner is a tenant with its
fits, or with its products: a product of some seconds lets a fit of half a second go first, and the
other way round. A job gets the number of its turn when it is accepted, and workers claim the jobs
of the lowest number first. So all workers and both databases keep the same order, and a job that is
put back keeps its place.

The numbers are those of start-time fair queueing (Goyal, Vin and Cheng 1996) with jobs of equal
cost: an owner's next job is one turn after its last one, and an owner who has nothing waiting
begins at the turn that is being served, not at the end of the queue.

A tenant does not get more turns by asking for both: each of its two owners lets one job of the
other go first. Numbers do not change once given, so an owner who filled the queue before the other
came keeps what it has, and a canceled job's turn passes.
"""

import time
from typing import Final

import sqlalchemy as sa
from sqlalchemy.exc import IntegrityError

from api_schemas.jobs import EventKind, JobState
from api_schemas.problems import problem
from service.jobs.database import available, read_then_write
from service.jobs.records import Idempotency, JobRecord, NewJob, Submission, SubmitOutcome
from service.jobs.rows import INPUTS, append_event, job_record, job_where
from service.jobs.sweep import ABANDONED_AFTER_S, enter_erasures, take_out
from service.jobs.tables import JOBS
from service.settings import Settings

_WAITING: Final = JOBS.c.state == JobState.QUEUED.value
_RUNNING: Final = JOBS.c.state == JobState.RUNNING.value

_OPTIONS_AT_FAULT: Final = problem("unusable-input", detail="", remedy="").type
"""The type of the problem of a product that would fail in the same way again."""


def product_of(tenant: str, fit_id: str, product: str) -> tuple[sa.ColumnElement[bool], ...]:
    """The condition that a job is this product of a tenant's fit."""
    return (JOBS.c.parent_id == fit_id, JOBS.c.product == product, JOBS.c.tenant == tenant)


class Submissions:
    """Submissions of one tenant; every method may raise :class:`EngineUnavailableError`.

    Both limits count pictures: of everybody's waiting jobs, and of the tenant's.
    """

    def __init__(self, tenant: str, database: sa.Engine, settings: Settings) -> None:
        self._tenant = tenant
        self._database = database
        self._settings = settings

    @available
    def reserve(self, job_id: str, idempotency: Idempotency | None) -> Submission:
        """Announce that blobs are about to be stored for a fit.

        The outcome is ``ACCEPTED``, but without a job, if they may be. The fit's scope is listed
        for erasure until the fit is accepted: an hour later it is erased.
        """
        with self._database.begin() as connection:
            answered = self._answered(connection, idempotency)
            if answered is not None:
                return answered
            enter_erasures(connection, [job_id], due_at=time.time() + ABANDONED_AFTER_S)
        return Submission(outcome=SubmitOutcome.ACCEPTED, job=None)

    @available
    def repeated(self, idempotency: Idempotency | None) -> Submission | None:
        """Return the answer to a submission that repeats an earlier key; None if it is new."""
        with self._database.connect() as connection:
            return self._earlier(connection, idempotency)

    @available
    def submit(self, job: NewJob) -> Submission:
        """Accept a fit durably, or say why not; its scope must have been reserved.

        Its record is all that a worker needs to find it.
        """
        try:
            with read_then_write(self._database) as connection:
                answered = self._answered(connection, job.idempotency)
                if answered is not None:
                    return answered
                if not take_out(connection, job.id):
                    return Submission(outcome=SubmitOutcome.LOST, job=None)
                record = self._insert(connection, job)
                append_event(connection, record, EventKind.STATE)
                return Submission(outcome=SubmitOutcome.ACCEPTED, job=record)
        except IntegrityError:
            # Two requests with the same new key raced; the other one is stored by now.
            repeated = self.repeated(job.idempotency)
            if repeated is None:
                raise
            return repeated

    @available
    def room_for_product(self, fit_id: str, product: str) -> Submission:
        """Return the product that is there already, or whether one more may be made.

        One that failed for another reason than what was asked for may be made once more.
        """
        with self._database.connect() as connection:
            return self._answered_product(connection, fit_id, product)

    @available
    def submit_product(self, fit_id: str, product: str, job: NewJob) -> Submission:
        """Accept a product durably, or say why not; its blobs lie in the fit's scope by now."""
        with read_then_write(self._database) as connection:
            if not self._lock_fit(connection, fit_id):
                return Submission(outcome=SubmitOutcome.FIT_GONE, job=None)
            answered = self._answered_product(connection, fit_id, product)
            if answered.outcome is not SubmitOutcome.ACCEPTED:
                return answered
            # One that failed gives way.
            connection.execute(sa.delete(JOBS).where(*product_of(self._tenant, fit_id, product)))
            record = self._insert(connection, job, parent=fit_id, product=product)
            return Submission(outcome=SubmitOutcome.ACCEPTED, job=record)

    def _answered(
        self, connection: sa.Connection, idempotency: Idempotency | None
    ) -> Submission | None:
        """The answer to a submission that is not accepted; None if there is room."""
        repeated = self._earlier(connection, idempotency)
        if repeated is not None:
            return repeated
        refused = self._no_room(connection)
        return None if refused is None else Submission(outcome=refused, job=None)

    def _earlier(
        self, connection: sa.Connection, idempotency: Idempotency | None
    ) -> Submission | None:
        if idempotency is None:
            return None
        earlier = job_where(
            connection,
            JOBS.c.tenant == self._tenant,
            JOBS.c.idempotency_key == idempotency.key,
        )
        if earlier is None:
            return None
        if earlier.fingerprint != idempotency.fingerprint:
            return Submission(outcome=SubmitOutcome.KEY_REUSED, job=None)
        return Submission(outcome=SubmitOutcome.REPEATED, job=earlier)

    def _answered_product(self, connection: sa.Connection, fit_id: str, product: str) -> Submission:
        found = job_where(connection, *product_of(self._tenant, fit_id, product))
        if found is not None and not _may_succeed_yet(found):
            return Submission(outcome=SubmitOutcome.REPEATED, job=found)
        refused = self._no_room(connection)
        return Submission(outcome=refused or SubmitOutcome.ACCEPTED, job=None)

    def _no_room(self, connection: sa.Connection) -> SubmitOutcome | None:
        """Why no more is accepted; None if there is room."""
        pictures = sa.func.sum(JOBS.c.pictures)
        ours = sa.func.sum(sa.case((JOBS.c.tenant == self._tenant, JOBS.c.pictures)))
        row = connection.execute(
            sa.select(pictures.label("everyone"), ours.label("ours")).where(_WAITING)
        ).one()
        if (row.everyone or 0) >= self._settings.max_queued:
            return SubmitOutcome.QUEUE_FULL
        if (row.ours or 0) >= self._settings.tenant_queue_limit:
            return SubmitOutcome.TENANT_FULL
        return None

    def _lock_fit(self, connection: sa.Connection, fit_id: str) -> bool:
        """Keep the fit from being erased until the end of the transaction; False if it is gone.

        The transaction must be one of :func:`read_then_write`.
        """
        fit = connection.execute(
            sa.select(JOBS.c.id)
            .where(
                JOBS.c.id == fit_id,
                JOBS.c.tenant == self._tenant,
                JOBS.c.parent_id.is_(None),
                JOBS.c.expires_at > time.time(),
            )
            .with_for_update()
        )
        return fit.scalar_one_or_none() is not None

    def _insert(
        self,
        connection: sa.Connection,
        job: NewJob,
        *,
        parent: str | None = None,
        product: str | None = None,
    ) -> JobRecord:
        key = job.idempotency
        is_product = parent is not None
        row = connection.execute(
            sa.insert(JOBS)
            .values(
                id=job.id,
                tenant=self._tenant,
                kind=job.kind,
                parent_id=parent,
                product=product,
                pictures=job.pictures,
                label=job.label,
                turn=turn_of_next_job(connection, tenant=self._tenant, is_product=is_product),
                state=JobState.QUEUED.value,
                progress=0.0,
                attempt=0,
                crashes=0,
                cancel_requested=False,
                created_at=time.time(),
                options_digest=job.options.digest,
                inputs=INPUTS.dump_json(dict(job.inputs)).decode(),
                files="[]",
                idempotency_key=None if key is None else key.key,
                fingerprint=None if key is None else key.fingerprint,
                request_id=job.request_id,
                last_event=1,
                webhook_target=job.webhook.digest if job.webhook else None,
            )
            .returning(JOBS)
        )
        return job_record(row.mappings().one())


def _may_succeed_yet(product: JobRecord) -> bool:
    """Whether it failed for another reason than what was asked for."""
    if product.state is JobState.FAILED:
        return product.problem is not None and product.problem.type != _OPTIONS_AT_FAULT
    return product.state is JobState.TIMED_OUT


def next_turn(*, begun: int | None, waiting: int | None, own: int | None, others: int) -> int:
    """Return the turn of one more job, counted from 1; None is where there is no such job.

    ``begun`` is the highest turn of the running jobs, ``waiting`` the lowest of those that wait,
    ``own`` the last of the owner's; ``others`` is 1 where the tenant's other owner has jobs
    waiting.
    """
    served = max(begun or 1, 1 if waiting is None else waiting - 1)
    earliest = served if own is None else max(served, own + 1)
    return earliest + others


def turn_of_next_job(connection: sa.Connection, *, tenant: str, is_product: bool) -> int:
    """Return the turn of a fit or a product that is being accepted in this transaction."""
    of_tenant = JOBS.c.tenant == tenant
    is_own = JOBS.c.parent_id.is_not(None) if is_product else JOBS.c.parent_id.is_(None)
    others = sa.and_(_WAITING, of_tenant, sa.not_(is_own))
    row = connection.execute(
        sa.select(
            sa.func.max(sa.case((_RUNNING, JOBS.c.turn))).label("begun"),
            sa.func.min(sa.case((_WAITING, JOBS.c.turn))).label("waiting"),
            sa.func.max(sa.case((sa.and_(of_tenant, is_own), JOBS.c.turn))).label("own"),
            sa.func.count(sa.distinct(sa.case((others, JOBS.c.tenant)))).label("others"),
        ).where(sa.or_(_WAITING, _RUNNING))
    ).one()
    return next_turn(begun=row.begun, waiting=row.waiting, own=row.own, others=row.others)
