"""Which notices of jobs' ends are due: columns of the jobs' own records.

A notice becomes due in the transaction that ends its job. A sender claims it by moving
``webhook_due_at`` ahead by a lease: if the sender dies, it becomes due again. The outcome of an
attempt is written only if that attempt is still the latest.
"""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import sqlalchemy as sa

from api_schemas.jobs import WebhookState
from service.engine.availability import available
from service.engine.port import JobRecord
from service.engine.records import job_record
from service.engine.tables import JOBS
from service.engine.transactions import read_then_write

LEASE_MARGIN_S: Final = 15.0
"""How much longer a lease lasts than the time limit of an attempt."""


@dataclass(frozen=True, slots=True, kw_only=True)
class DueWebhook:
    """A notice claimed for its ``attempt``, counted from 1."""

    job: JobRecord
    attempt: int


class WebhookLedger:
    """What is due, claimed and settled; an attempt lasts up to ``time_limit_s``."""

    def __init__(self, database: sa.Engine, *, time_limit_s: float) -> None:
        self._database = database
        self._lease_s = time_limit_s + LEASE_MARGIN_S

    @available
    def claim(self, limit: int) -> Sequence[DueWebhook]:
        """Take notices that are due, longest due first."""
        now = time.time()
        due = (
            sa.select(JOBS.c.id)
            .where(JOBS.c.webhook_due_at <= now)
            .order_by(JOBS.c.webhook_due_at)
            .limit(limit)
        )
        with self._database.connect() as connection:
            # Usually there is none, which spares SQLite a write transaction.
            if connection.execute(due).first() is None:
                return ()
        with read_then_write(self._database) as connection:
            ids = list(connection.execute(due.with_for_update(skip_locked=True)).scalars())
            rows = connection.execute(
                sa.update(JOBS)
                .where(JOBS.c.id.in_(ids))
                .values(
                    webhook_due_at=now + self._lease_s,
                    webhook_attempts=JOBS.c.webhook_attempts + 1,
                )
                .returning(JOBS)
            ).mappings()
            return [
                DueWebhook(job=job_record(row), attempt=row["webhook_attempts"]) for row in rows
            ]

    @available
    def settle(
        self,
        due: DueWebhook,
        *,
        state: WebhookState,
        status: int | None,
        error: str | None,
        again_in_s: float | None,
    ) -> None:
        """Record the outcome of an attempt; ``again_in_s`` is None if it is the last one."""
        self._write(
            due,
            webhook_state=state.value,
            webhook_status=status,
            webhook_error=error,
            webhook_due_at=None if again_in_s is None else time.time() + again_in_s,
        )

    @available
    def hand_back(self, due: DueWebhook, *, in_s: float = 0.0) -> None:
        """Make a claimed notice due again, as if it had not been claimed."""
        self._write(due, webhook_due_at=time.time() + in_s, webhook_attempts=due.attempt - 1)

    def _write(self, due: DueWebhook, **values: object) -> None:
        with self._database.begin() as connection:
            connection.execute(
                sa.update(JOBS)
                .where(
                    JOBS.c.id == due.job.id,
                    JOBS.c.webhook_state == WebhookState.DUE.value,
                    JOBS.c.webhook_attempts == due.attempt,
                )
                .values(**values)
            )
