"""The products of one fit, as our records have them: jobs whose blobs lie in the fit's scope.

A product's record is a row among those of the fits, so that workers claim it, run it and survive
over it as they do with these. It has neither events nor an end of its own: it goes with its fit.
"""

import time
from collections.abc import Mapping
from typing import Final
from uuid import uuid4

import sqlalchemy as sa

from api_schemas.jobs import JobState
from api_schemas.problems import problem
from service.jobs.admission import Admission
from service.jobs.availability import available
from service.jobs.port import JobRecord, NewProduct, Submission, SubmitOutcome
from service.jobs.records import INPUTS, job_record
from service.jobs.tables import JOBS
from service.jobs.transactions import read_then_write
from service.jobs.turns import turn_of_next_job

_OPTIONS_AT_FAULT: Final = problem("unusable-input", detail="", remedy="").type
"""The type of the problem of a product that would fail in the same way again."""


class FitProducts:
    """The products of one fit; every method may raise :class:`EngineUnavailableError`."""

    def __init__(self, fit_id: str, *, database: sa.Engine, admission: Admission) -> None:
        self._fit_id = fit_id
        self._database = database
        self._admission = admission

    @available
    def product(self, product_id: str) -> JobRecord | None:
        """Return the product, or None if there is none."""
        with self._database.connect() as connection:
            return self._find(connection, product_id)

    @available
    def room(self, product_id: str) -> Submission:
        """Return the product that is there already, or whether one more may be made.

        One that failed for another reason than what was asked for may be made once more.
        """
        with self._database.connect() as connection:
            return self._answered(connection, product_id)

    @available
    def submit(self, product: NewProduct) -> Submission:
        """Accept a product durably, or say why not; its blobs lie in the fit's scope by now."""
        with read_then_write(self._database) as connection:
            if not self._lock_fit(connection):
                return Submission(outcome=SubmitOutcome.FIT_GONE, job=None)
            answered = self._answered(connection, product.id)
            if answered.outcome is not SubmitOutcome.ACCEPTED:
                return answered
            # One that failed gives way.
            connection.execute(sa.delete(JOBS).where(*self._of(product.id)))
            record = job_record(
                connection.execute(
                    sa.insert(JOBS)
                    .values(
                        id=str(uuid4()),
                        tenant=self._admission.tenant,
                        parent_id=self._fit_id,
                        product=product.id,
                        **_new_values(connection, product, tenant=self._admission.tenant),
                    )
                    .returning(JOBS)
                )
                .mappings()
                .one()
            )
        return Submission(outcome=SubmitOutcome.ACCEPTED, job=record)

    def _answered(self, connection: sa.Connection, product_id: str) -> Submission:
        found = self._find(connection, product_id)
        if found is not None and not _may_succeed_yet(found):
            return Submission(outcome=SubmitOutcome.REPEATED, job=found)
        refused = self._admission.no_room(connection)
        return Submission(outcome=refused or SubmitOutcome.ACCEPTED, job=None)

    def _lock_fit(self, connection: sa.Connection) -> bool:
        """Keep the fit from being erased until the end of the transaction; False if it is gone.

        The transaction must be one of :func:`read_then_write`.
        """
        fit = connection.execute(
            sa.select(JOBS.c.id)
            .where(
                JOBS.c.id == self._fit_id,
                JOBS.c.tenant == self._admission.tenant,
                JOBS.c.parent_id.is_(None),
                JOBS.c.expires_at > time.time(),
            )
            .with_for_update()
        ).scalar_one_or_none()
        return fit is not None

    def _find(self, connection: sa.Connection, product_id: str) -> JobRecord | None:
        query = sa.select(JOBS).where(*self._of(product_id))
        row = connection.execute(query).mappings().one_or_none()
        return None if row is None else job_record(row)

    def _of(self, product_id: str) -> tuple[sa.ColumnElement[bool], ...]:
        return (
            JOBS.c.parent_id == self._fit_id,
            JOBS.c.product == product_id,
            JOBS.c.tenant == self._admission.tenant,
        )


def _new_values(
    connection: sa.Connection, product: NewProduct, *, tenant: str
) -> Mapping[str, object]:
    return {
        "kind": product.kind,
        "pictures": 1,
        "turn": turn_of_next_job(connection, tenant=tenant, is_product=True),
        "state": JobState.QUEUED.value,
        "progress": 0.0,
        "attempt": 0,
        "crashes": 0,
        "cancel_requested": False,
        "created_at": time.time(),
        "options_digest": product.options.digest,
        "inputs": INPUTS.dump_json(dict(product.inputs)).decode(),
        "files": "[]",
        "request_id": product.request_id,
        "last_event": 1,
    }


def _may_succeed_yet(product: JobRecord) -> bool:
    """Whether it failed for another reason than what was asked for."""
    if product.state is JobState.FAILED:
        return product.problem is not None and product.problem.type != _OPTIONS_AT_FAULT
    return product.state is JobState.TIMED_OUT
