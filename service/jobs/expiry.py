"""Expiry and erasure: jobs expire, and what has to be erased stays listed until it is gone.

Blobs are not in the database, so no transaction covers both. A scope that has to be erased is
listed in a table of its own, by the transaction that forgets the job, and removed from it only
after its blobs are gone: if the process dies in between, the next sweep continues. A submission
lists its scope before it stores the first byte and removes it when the job is accepted.
"""

import logging
import time
from collections.abc import Callable, Iterable, Sequence
from typing import Final

import sqlalchemy as sa

from api_schemas.jobs import JobState
from service.jobs.tables import ERASURES, IMAGES, JOBS, TOMBSTONES

LOG: Final = logging.getLogger(__name__)

ABANDONED_AFTER_S: Final = 3_600.0
"""A submission that stored its picture but was not completed within this time is abandoned."""

LATE_WRITES_S: Final = 600.0
"""A worker that is out of reach may still store results of a job that was erased meanwhile; the
scope is erased once more after this time."""

TOMBSTONES_KEPT_S: Final = 90 * 86_400.0
BATCH: Final = 200
EXPIRED_AT_ONCE: Final = 50
"""Jobs, with all their events, per transaction."""

POSTPONED_S: Final = 600.0
"""A scope that could not be erased is retried after this time; others do not wait for it."""

JUMP_S: Final = 60.0
"""A wall clock that differs from the elapsed time by more than this was set."""

SETTLING_S: Final = 3_600.0
"""Nothing expires for this long after a jump: what is erased cannot be brought back, but a clock
that was set wrong can be corrected."""


class ClockGuard:
    """Notices when the wall clock jumps."""

    def __init__(
        self,
        *,
        wall: Callable[[], float] = time.time,
        monotonic: Callable[[], float] = time.monotonic,
    ) -> None:
        self._wall = wall
        self._monotonic = monotonic
        self._offset = wall() - monotonic()
        self._settled_at = monotonic()

    def settled_time(self) -> float | None:
        """The wall clock's time; None unless it has run evenly for a while.

        Whatever expires by it must be asked with this time: the clock may jump right after.
        """
        now, wall = self._monotonic(), self._wall()
        offset = wall - now
        if abs(offset - self._offset) > JUMP_S:
            LOG.warning(
                "The clock jumped by %.0f s; nothing expires for %.0f s.",
                offset - self._offset,
                SETTLING_S,
            )
            self._settled_at = now + SETTLING_S
        self._offset = offset
        return wall if now >= self._settled_at else None


def enter_erasures(connection: sa.Connection, scopes: Sequence[str], *, due_at: float) -> None:
    """List these scopes for erasure from ``due_at`` on."""
    if scopes:
        connection.execute(
            sa.insert(ERASURES), [{"scope": scope, "due_at": due_at} for scope in scopes]
        )


def take_out(connection: sa.Connection, scope: str) -> bool:
    """Remove a scope from those to be erased; returns whether it was still listed."""
    return connection.execute(sa.delete(ERASURES).where(ERASURES.c.scope == scope)).rowcount > 0


def forget_job(
    connection: sa.Connection, job_id: str, *conditions: sa.ColumnElement[bool]
) -> Sequence[str]:
    """Delete a fit and its products, and list the fit's scope, in which all their blobs are.

    Returns the ids of all that was deleted; none if there was no such fit.
    """
    deleted = sa.delete(JOBS).returning(JOBS.c.id, JOBS.c.state)
    fits = connection.execute(deleted.where(JOBS.c.id == job_id, *conditions)).all()
    if not fits:
        return ()
    # After the fit itself: a product that was being accepted is there by now, or never will be.
    products = connection.execute(deleted.where(JOBS.c.parent_id == job_id)).all()
    forgotten = {row.id: row.state for row in (*fits, *products)}
    _enter_scope(connection, job_id, forgotten.values())
    return list(forgotten)


def _enter_scope(connection: sa.Connection, scope: str, states: Iterable[str]) -> None:
    """List the scope of a deleted fit for erasure; ``states`` are its own and its products'."""
    may_be_written = JobState.RUNNING.value in states
    due_at = time.time() + (LATE_WRITES_S if may_be_written else 0.0)
    enter_erasures(connection, [scope], due_at=due_at)


def expire_jobs(connection: sa.Connection, now: float) -> int:
    """Forget the fits that have expired, keeping only their ids; returns how many."""
    ids = list(
        connection.execute(
            sa.select(JOBS.c.id)
            .where(JOBS.c.expires_at <= now)
            .limit(EXPIRED_AT_ONCE)
            # Two processes may sweep at once.
            .with_for_update(skip_locked=True)
        ).scalars()
    )
    if not ids:
        return 0
    fits = connection.execute(
        sa.delete(JOBS)
        .where(JOBS.c.id.in_(ids))
        .returning(JOBS.c.id, JOBS.c.tenant, JOBS.c.expires_at)
    ).all()
    products = connection.execute(
        sa.delete(JOBS).where(JOBS.c.parent_id.in_(ids)).returning(JOBS.c.parent_id, JOBS.c.state)
    ).all()
    connection.execute(
        sa.insert(TOMBSTONES),
        [{"id": fit.id, "tenant": fit.tenant, "expired_at": fit.expires_at} for fit in fits],
    )
    for fit in fits:
        of_fit = (product.state for product in products if product.parent_id == fit.id)
        _enter_scope(connection, fit.id, of_fit)
    return len(fits)


def expire_images(connection: sa.Connection, now: float) -> int:
    """Forget the uploaded pictures that have expired; returns how many."""
    scopes = list(
        connection.execute(
            sa.delete(IMAGES).where(IMAGES.c.expires_at <= now).returning(IMAGES.c.scope)
        ).scalars()
    )
    enter_erasures(connection, scopes, due_at=now)
    return len(scopes)


def drop_old_tombstones(connection: sa.Connection, now: float) -> None:
    """Forget that jobs expired long ago."""
    connection.execute(
        sa.delete(TOMBSTONES).where(TOMBSTONES.c.expired_at < now - TOMBSTONES_KEPT_S)
    )


def due_erasures(connection: sa.Connection) -> list[str]:
    """Return scopes whose blobs are to be erased now."""
    query = sa.select(ERASURES.c.scope).where(ERASURES.c.due_at <= time.time()).limit(BATCH)
    return list(connection.execute(query).scalars())


def postpone(connection: sa.Connection, scope: str) -> None:
    """Put off erasing a scope until later."""
    connection.execute(
        sa.update(ERASURES)
        .where(ERASURES.c.scope == scope)
        .values(due_at=time.time() + POSTPONED_S)
    )


def forget_pages(database: sa.Engine) -> None:
    """Return free pages of an embedded database to the disk, and empty its write-ahead log.

    Erased rows are also in the log, and the file does not shrink on its own.
    """
    if database.dialect.name != "sqlite":
        return
    with database.connect() as connection:
        connection.execute(sa.text("PRAGMA incremental_vacuum"))
        connection.execute(sa.text("PRAGMA wal_checkpoint(TRUNCATE)"))
