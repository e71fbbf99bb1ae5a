"""The sweep: jobs expire, and what has to be erased stays listed until it is gone.

Blobs are not in the database, so no transaction covers both. A scope that has to be erased is
listed in a table of its own, by the transaction that forgets the job, and removed from it only
after its blobs are gone: if the process dies in between, the next sweep continues. A submission
lists its scope before it stores the first byte and removes it when the job is accepted.
"""

import logging
import re
import threading
import time
from collections.abc import Callable, Sequence
from typing import Any, Final

import sqlalchemy as sa
from dbos import DBOSClient
from sqlalchemy.exc import OperationalError

from api_schemas.jobs import JobState
from service.jobs.blobs import BlobStore, BlobsUnavailableError
from service.jobs.database import insert_or_update, read_then_write
from service.jobs.notices import enqueue_left, notice_of
from service.jobs.tables import ERASURES, IMAGES, JOBS, TOMBSTONES

LOG: Final = logging.getLogger(__name__)

ABANDONED_AFTER_S: Final = 3_600.0
"""A submission that stored its picture but was not completed within this time is abandoned."""

LATE_WRITES_S: Final = 600.0
"""A worker that is out of reach may still store results of a job that was erased meanwhile; the
scope is erased once more after this time."""

TOMBSTONES_KEPT_S: Final = 90 * 86_400.0

UNKNOWN_KEPT_S: Final = 86_400.0
"""A folder that no record names is kept so long: somebody may have given the service a database of
yesterday by mistake."""

UNKNOWN_SOUGHT_S: Final = 86_400.0
OUR_SCOPES: Final = re.compile(r"[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}|\.probe-[0-9a-f]{32}")
"""Names of fits' and pictures' scopes, and of those that readiness writes: others are not ours."""

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


def forget_fits(
    connection: sa.Connection, *which: sa.ColumnElement[bool]
) -> Sequence[sa.Row[*tuple[Any, ...]]]:
    """Delete fits and their products, and list the fits' scopes, in which all their blobs are.

    Returns id, parent, tenant and expiry of all that was deleted.
    """
    deleted = sa.delete(JOBS).returning(
        JOBS.c.id, JOBS.c.parent_id, JOBS.c.tenant, JOBS.c.state, JOBS.c.expires_at
    )
    fits = connection.execute(deleted.where(*which)).all()
    ids = [fit.id for fit in fits]
    # After the fits: a product that was being accepted is there by now, or never will be.
    products = connection.execute(deleted.where(JOBS.c.parent_id.in_(ids))).all() if ids else ()
    forgotten = (*fits, *products)
    running = {row.parent_id or row.id for row in forgotten if row.state == JobState.RUNNING.value}
    for fit_id in ids:
        due_at = time.time() + (LATE_WRITES_S if fit_id in running else 0.0)
        enter_erasures(connection, [fit_id], due_at=due_at)
    return forgotten


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
    forgotten = forget_fits(connection, JOBS.c.id.in_(ids))
    fits = [row for row in forgotten if row.parent_id is None]
    connection.execute(
        sa.insert(TOMBSTONES),
        [{"id": fit.id, "tenant": fit.tenant, "expired_at": fit.expires_at} for fit in fits],
    )
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


def known_scopes(connection: sa.Connection, scopes: Sequence[str]) -> set[str]:
    """Return which of these scopes a fit, a picture or an erasure names."""
    # One statement, so that no scope passes from one table to another in between.
    known = sa.union_all(
        *(
            sa.select(column).where(column.in_(scopes))
            for column in (JOBS.c.id, IMAGES.c.scope, ERASURES.c.scope)
        )
    )
    return set(connection.execute(known).scalars())


def forget_pages(database: sa.Engine) -> None:
    """Return free pages of an embedded database to the disk, and empty its write-ahead log.

    Erased rows are also in the log, and the file does not shrink on its own.
    """
    if database.dialect.name != "sqlite":
        return
    with database.connect() as connection:
        connection.execute(sa.text("PRAGMA incremental_vacuum"))
        connection.execute(sa.text("PRAGMA wal_checkpoint(TRUNCATE)"))


def forget_workflows(client: DBOSClient, job_id: str) -> None:
    """Delete what DBOS stores of a job: its execution and its notice."""
    for each in (job_id, notice_of(job_id)):
        client.cancel_workflow(each)
        client.delete_workflow(each)


class Sweeper:
    """Sweeps every ``interval_s``; several processes may do so on one database."""

    def __init__(
        self,
        database: sa.Engine,
        client: DBOSClient,
        blobs: BlobStore,
        *,
        interval_s: float,
    ) -> None:
        self._database = database
        self._client = client
        self._blobs = blobs
        self._interval_s = interval_s
        self._clock = ClockGuard()
        self._unknown_at = time.monotonic()
        self._stopped = threading.Event()
        self._thread = threading.Thread(target=self._run, name="sweeper", daemon=True)

    def start(self) -> None:
        """Start; the first sweep is one interval from now."""
        self._thread.start()

    def stop(self) -> None:
        """Stop after the scope that is being erased."""
        self._stopped.set()
        self._thread.join()

    def sweep(self) -> int:
        """Expire and erase what is due; returns how many scopes were erased."""
        enqueue_left(self._client)
        now = self._clock.settled_time()
        if now is not None:
            self._expire(now)
        self._find_unknown()
        erased = 0
        while not self._stopped.is_set() and (scopes := self._due()):
            erased += sum(self._erase(scope) for scope in scopes)
        if erased:
            forget_pages(self._database)
        return erased

    def _expire(self, now: float) -> None:
        while not self._stopped.is_set():
            with read_then_write(self._database) as connection:
                if expire_jobs(connection, now) == 0:
                    break
        with self._database.begin() as connection:
            expire_images(connection, now)
            old = TOMBSTONES.c.expired_at < now - TOMBSTONES_KEPT_S
            connection.execute(sa.delete(TOMBSTONES).where(old))

    def _find_unknown(self) -> None:
        """List for erasure, once a day, scopes that no record names: after a day they are erased.

        They are what a database left that was lost, or a worker that was out of reach for long.
        """
        now = time.monotonic()
        if now < self._unknown_at:
            return
        scopes = [each for each in self._blobs.scopes() if OUR_SCOPES.fullmatch(each)]
        for start in range(0, len(scopes), BATCH):
            batch = scopes[start : start + BATCH]
            with self._database.begin() as connection:
                unknown = set(batch) - known_scopes(connection, batch)
                for scope in unknown:
                    LOG.warning("Nothing is known of the folder %s; it goes in a day.", scope)
                    connection.execute(
                        insert_or_update(connection, ERASURES)
                        .values(scope=scope, due_at=time.time() + UNKNOWN_KEPT_S)
                        .on_conflict_do_nothing()
                    )
        self._unknown_at = now + UNKNOWN_SOUGHT_S

    def _due(self) -> list[str]:
        query = sa.select(ERASURES.c.scope).where(ERASURES.c.due_at <= time.time()).limit(BATCH)
        with self._database.connect() as connection:
            return list(connection.execute(query).scalars())

    def _erase(self, scope: str) -> bool:
        try:
            self._blobs.erase(scope)
        except BlobsUnavailableError as error:
            LOG.warning("The blobs of %s cannot be erased now (%s).", scope, error)
            later = sa.update(ERASURES).values(due_at=time.time() + POSTPONED_S)
            with self._database.begin() as connection:
                connection.execute(later.where(ERASURES.c.scope == scope))
            return False
        # Also what DBOS stores about it: a no-op if DELETE has already done so.
        forget_workflows(self._client, scope)
        with self._database.begin() as connection:
            take_out(connection, scope)
        return True

    def _run(self) -> None:
        while not self._stopped.wait(self._interval_s):
            try:
                erased = self.sweep()
            except OperationalError as error:
                LOG.warning("The database is not available (%s); nothing is erased.", error.orig)
            except BlobsUnavailableError as error:
                LOG.warning("The storage is not available (%s); nothing is erased.", error)
            except Exception:
                LOG.exception("Erasing what has expired failed.")
            else:
                if erased:
                    LOG.info("Erased %d expired or forgotten jobs and pictures.", erased)
