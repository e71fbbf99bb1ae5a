"""A thread that erases what has expired, and what should have been erased but is still there."""

import logging
import threading
from typing import Final

import sqlalchemy as sa
from dbos import DBOSClient
from sqlalchemy.exc import OperationalError

from service.blobs import BlobStore, BlobsUnavailableError
from service.jobs.expiry import (
    ClockGuard,
    drop_old_tombstones,
    due_erasures,
    expire_images,
    expire_jobs,
    forget_pages,
    postpone,
    take_out,
)
from service.jobs.notices import Notices, notice_of
from service.jobs.transactions import read_then_write

LOG: Final = logging.getLogger(__name__)


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
        self._notices = Notices(database)
        self._clock = ClockGuard()
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
        self._notices.enqueue_left()
        now = self._clock.settled_time()
        if now is not None:
            while not self._stopped.is_set():
                if self._expire_jobs(now) == 0:
                    break
            self._expire_others(now)
        erased = 0
        while not self._stopped.is_set():
            with self._database.connect() as connection:
                scopes = due_erasures(connection)
            if not scopes:
                break
            erased += sum(self._erase(scope) for scope in scopes)
        if erased:
            forget_pages(self._database)
        return erased

    def _expire_jobs(self, now: float) -> int:
        with read_then_write(self._database) as connection:
            return expire_jobs(connection, now)

    def _expire_others(self, now: float) -> None:
        with self._database.begin() as connection:
            expire_images(connection, now)
            drop_old_tombstones(connection, now)

    def _erase(self, scope: str) -> bool:
        try:
            self._blobs.erase(scope)
        except BlobsUnavailableError as error:
            LOG.warning("The blobs of %s cannot be erased now (%s).", scope, error)
            with self._database.begin() as connection:
                postpone(connection, scope)
            return False
        self._forget(scope)
        return True

    def _forget(self, scope: str) -> None:
        # Also what DBOS stores about it: a no-op if DELETE has already done so.
        for each in (scope, notice_of(scope)):
            self._client.cancel_workflow(each)
            self._client.delete_workflow(each)
        with self._database.begin() as connection:
            take_out(connection, scope)

    def _run(self) -> None:
        while not self._stopped.wait(self._interval_s):
            try:
                erased = self.sweep()
            except OperationalError as error:
                LOG.warning("The database is not available (%s); nothing is erased.", error.orig)
            except Exception:
                LOG.exception("Erasing what has expired failed.")
            else:
                if erased:
                    LOG.info("Erased %d expired or forgotten jobs and pictures.", erased)
