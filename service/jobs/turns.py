"""Fair queueing: owners take turns, and each owner's jobs are started in their order.

An owner is a tenant with its fits, or with its products: a product of some seconds lets a fit of
half a second go first, and the other way round. A job gets the number of its turn when it is
accepted, and workers claim the jobs of the lowest number first. So all workers and both
databases keep the same order, and a job that is put back keeps its place.

The numbers are those of start-time fair queueing (Goyal, Vin and Cheng 1996) with jobs of equal
cost: an owner's next job is one turn after its last one, and an owner who has nothing waiting
begins at the turn that is being served, not at the end of the queue.

A tenant does not get more turns by asking for both: each of its two owners lets one job of the
other go first. Numbers do not change once given, so an owner who filled the queue before the other
came keeps what it has, and a canceled job's turn passes.
"""

from dataclasses import dataclass

import sqlalchemy as sa

from api_schemas.jobs import JobState
from service.jobs.tables import JOBS

_WAITING = JOBS.c.state == JobState.QUEUED.value
_RUNNING = JOBS.c.state == JobState.RUNNING.value
_IS_PRODUCT = JOBS.c.parent_id.is_not(None)
_OF_TENANT = JOBS.c.tenant == sa.bindparam("its_tenant")
_OWN = sa.and_(_OF_TENANT, sa.bindparam("of_products", type_=sa.Boolean) == _IS_PRODUCT)

# Written out once: putting a statement together takes longer than executing it.
_QUEUE = sa.select(
    sa.func.max(sa.case((_RUNNING, JOBS.c.turn))).label("begun"),
    sa.func.min(sa.case((_WAITING, JOBS.c.turn))).label("waiting"),
    sa.func.max(sa.case((_OWN, JOBS.c.turn))).label("own"),
    sa.func.count(
        sa.distinct(sa.case((sa.and_(_WAITING, _OF_TENANT, sa.not_(_OWN)), JOBS.c.tenant)))
    ).label("others"),
).where(sa.or_(_WAITING, _RUNNING))


@dataclass(frozen=True, slots=True, kw_only=True)
class QueueSight:
    """The queue as it is when a job is accepted; the numbers are turns, None where there is none.

    ``begun`` is the highest of the running jobs, ``waiting`` the lowest of those that wait, ``own``
    the last of the owner's; ``others`` is 1 where the tenant's other owner has jobs waiting.
    """

    begun: int | None
    waiting: int | None
    own: int | None
    others: int


def next_turn(seen: QueueSight) -> int:
    """Return the turn of one more job, counted from 1."""
    served = max(seen.begun or 1, 1 if seen.waiting is None else seen.waiting - 1)
    earliest = served if seen.own is None else max(served, seen.own + 1)
    return earliest + seen.others


def turn_of_next_job(connection: sa.Connection, *, tenant: str, is_product: bool) -> int:
    """Return the turn of a fit or a product that is being accepted in this transaction."""
    row = connection.execute(_QUEUE, {"its_tenant": tenant, "of_products": is_product}).one()
    return next_turn(
        QueueSight(begun=row.begun, waiting=row.waiting, own=row.own, others=row.others)
    )
