"""Whether one more job of a tenant is accepted: room, and repeated requests."""

from dataclasses import dataclass

import sqlalchemy as sa

from api_schemas.jobs import JobState
from service.jobs.port import Idempotency, Submission, SubmitOutcome
from service.jobs.records import job_record
from service.jobs.tables import JOBS


@dataclass(frozen=True, slots=True, kw_only=True)
class Admission:
    """What a tenant may have waiting.

    Both limits count pictures: of everybody's waiting jobs, and of the tenant's.
    """

    tenant: str
    max_queued: int
    max_queued_per_tenant: int

    def answered(
        self, connection: sa.Connection, idempotency: Idempotency | None
    ) -> Submission | None:
        """Return the answer to a submission that is not accepted; None if there is room."""
        repeated = self.earlier(connection, idempotency)
        if repeated is not None:
            return repeated
        refused = self.no_room(connection)
        return None if refused is None else Submission(outcome=refused, job=None)

    def earlier(
        self, connection: sa.Connection, idempotency: Idempotency | None
    ) -> Submission | None:
        """Return the answer to an earlier submission with this key; None if there is none."""
        if idempotency is None:
            return None
        row = (
            connection.execute(
                sa.select(JOBS).where(
                    JOBS.c.tenant == self.tenant,
                    JOBS.c.idempotency_key == idempotency.key,
                )
            )
            .mappings()
            .one_or_none()
        )
        if row is None:
            return None
        earlier = job_record(row)
        if earlier.fingerprint != idempotency.fingerprint:
            return Submission(outcome=SubmitOutcome.KEY_REUSED, job=None)
        return Submission(outcome=SubmitOutcome.REPEATED, job=earlier)

    def no_room(self, connection: sa.Connection) -> SubmitOutcome | None:
        """Return why no more is accepted; None if there is room."""
        waiting = JOBS.c.state == JobState.QUEUED.value
        everyone, ours = connection.execute(
            sa.select(
                sa.func.coalesce(sa.func.sum(JOBS.c.pictures), 0),
                sa.func.coalesce(
                    sa.func.sum(sa.case((JOBS.c.tenant == self.tenant, JOBS.c.pictures))), 0
                ),
            ).where(waiting)
        ).one()
        if everyone >= self.max_queued:
            return SubmitOutcome.QUEUE_FULL
        if ours >= self.max_queued_per_tenant:
            return SubmitOutcome.TENANT_FULL
        return None
