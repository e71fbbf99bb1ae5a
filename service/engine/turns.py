"""Fair queueing: tenants take turns, and each tenant's jobs are started in their order.

A job gets the number of its turn when it is accepted, and workers claim the jobs of the lowest
number first. So all workers and both databases keep the same order, and a job that is put back
keeps its place. A canceled job's turn passes.

The numbers are those of start-time fair queueing (Goyal, Vin and Cheng 1996) with jobs of equal
cost: a tenant's next job is one turn after its last one, and a tenant that has nothing waiting
begins at the turn that is being served, not at the end of the queue.
"""

from dataclasses import dataclass

import sqlalchemy as sa

from api_schemas.jobs import JobState
from service.engine.tables import JOBS

_WAITING = JOBS.c.state == JobState.QUEUED.value
_RUNNING = JOBS.c.state == JobState.RUNNING.value
_OWN = JOBS.c.tenant == sa.bindparam("its_tenant")

# Written out once: putting a statement together takes longer than executing it.
_QUEUE = sa.select(
    sa.func.max(sa.case((_RUNNING, JOBS.c.turn))).label("begun"),
    sa.func.min(sa.case((_WAITING, JOBS.c.turn))).label("waiting"),
    sa.func.max(sa.case((_OWN, JOBS.c.turn))).label("own"),
).where(sa.or_(_WAITING, _RUNNING))


@dataclass(frozen=True, slots=True, kw_only=True)
class QueueSight:
    """The queue as it is when a job is accepted; the numbers are turns, None where there is none.

    ``begun`` is the highest of the running jobs, ``waiting`` the lowest of those that wait, ``own``
    the last of the tenant's.
    """

    begun: int | None
    waiting: int | None
    own: int | None


def next_turn(seen: QueueSight) -> int:
    """Return the turn of one more job, counted from 1."""
    served = max(seen.begun or 1, 1 if seen.waiting is None else seen.waiting - 1)
    return served if seen.own is None else max(served, seen.own + 1)


def turn_of_next_job(connection: sa.Connection, *, tenant: str) -> int:
    """Return the turn of a job that is being accepted in this transaction."""
    row = connection.execute(_QUEUE, {"its_tenant": tenant}).one()
    return next_turn(QueueSight(begun=row.begun, waiting=row.waiting, own=row.own))
