"""A worker's heartbeat, and the recovery of fits whose worker died.

Open-source DBOS recovers a process's own jobs when it restarts under the same name. Our workers
never reuse a name, so each also watches the others: if one that has claimed jobs is dead, its jobs
wait again.
"""

import logging
import threading
import time
from collections.abc import Callable, Collection
from typing import Final

import sqlalchemy as sa
from dbos import DBOSClient

from service.jobs.claims import Claims
from service.jobs.database import ABSENCES
from service.jobs.executions import CONTINUE_S, holders, queue_of
from service.jobs.liveness import WorkerWatch, this_process
from service.jobs.slots import WorkerSlots
from service.jobs.tables import WORKERS

LOG: Final = logging.getLogger(__name__)

DROPPED_AFTER_S: Final = 5.0
"""Time that a job may be claimed by a worker that does not run it, seconds: many times as long as a
claim takes to be made or given up."""


class Heartbeat:
    """A thread that beats, and recovers the fits of dead workers."""

    def __init__(
        self,
        database: sa.Engine,
        *,
        executor_id: str,
        interval_s: float,
        dead_after_s: float,
        claims: Claims,
        client: DBOSClient,
        slots: WorkerSlots,
        is_able: Callable[[], bool],
        monotonic: Callable[[], float] = time.monotonic,
    ) -> None:
        self._database = database
        self._executor_id = executor_id
        self._interval_s = interval_s
        self._claims = claims
        self._client = client
        self._slots = slots
        self._is_able = is_able
        self._monotonic = monotonic
        self._watch = WorkerWatch(dead_after_s=dead_after_s)
        self._process = this_process()
        self._stopped = threading.Event()
        self._has_queue = False
        self._dropped_since: dict[str, float] = {}
        self._thread = threading.Thread(target=self._run, name="heartbeat", daemon=True)

    def start(self) -> None:
        """Begin to beat and to watch the others: DBOS must be running by now."""
        self._thread.start()

    def stop(self) -> None:
        """Stop beating and sign off, so that nobody waits for this worker."""
        self._stopped.set()
        self._thread.join()
        self._forget([self._executor_id])

    def _run(self) -> None:
        while True:
            try:
                self.beat()
                self._take_over()
                self._pick_up()
            except ABSENCES as error:
                cause = getattr(error, "orig", None) or error
                LOG.warning("The database is not available (%s).", cause)
                # Nothing could begin meanwhile.
                self._dropped_since.clear()
            except Exception:
                # The database may be unavailable and come back; the heartbeat must never stop.
                LOG.exception("A heartbeat failed.")
            if self._stopped.wait(self._interval_s):
                return

    def beat(self) -> None:
        """Say that this worker is there; once before it claims anything."""
        able = self._is_able()
        with self._database.begin() as connection:
            beaten = connection.execute(
                sa.update(WORKERS)
                .where(WORKERS.c.executor_id == self._executor_id)
                .values(beat=WORKERS.c.beat + 1, able=able)
            )
            if beaten.rowcount == 0:
                # The first beat, or the others took this worker for dead and removed it.
                self._has_queue = False
                connection.execute(
                    sa.insert(WORKERS).values(
                        executor_id=self._executor_id,
                        beat=0,
                        able=able,
                        **self._process,
                    )
                )
        if not self._has_queue:
            queue = queue_of(self._executor_id)
            self._client.register_queue(queue, polling_interval_sec=CONTINUE_S)
            self._has_queue = True

    def _take_over(self) -> None:
        # In this order: a worker makes itself known before it claims anything.
        claimed_by, executions = self._claims.holders(), holders(self._client)
        with self._database.connect() as connection:
            workers = connection.execute(sa.select(WORKERS)).all()
        alive = self._watch.alive(workers) | {self._executor_id}
        dead = sorted(claimed_by - alive)
        if dead:
            LOG.warning("Taking over the jobs of %s.", ", ".join(dead))
            self._claims.take_from(dead)
        left = {job for job, holder in executions.items() if holder not in alive}
        if left:
            # Those of jobs that have ended: their workers died before DBOS had recorded it.
            ended = left - self._claims.waiting_or_held(left)
            if ended:
                self._client.delete_workflows(list(ended))
        gone = [row.executor_id for row in workers if row.executor_id not in alive]
        if gone:
            self._forget(gone)

    def _pick_up(self) -> None:
        """Put back what this worker has claimed but does not run.

        Its thread ended in an error, as when DBOS itself cannot write what a fit returned, the disk
        being full. Or it never began: it was erased meanwhile.
        """
        not_begun = set(self._slots.not_begun())
        dropped = (self._claims.held() - set(self._slots.held())) | not_begun
        now = self._monotonic()
        self._dropped_since = {each: self._dropped_since.get(each, now) for each in dropped}
        for job_id, since in list(self._dropped_since.items()):
            if now - since >= DROPPED_AFTER_S:
                LOG.warning("job=%s was dropped by this worker and is put back.", job_id)
                self._claims.put_back(job_id)
                if job_id in not_begun:
                    self._slots.free(job_id)
                del self._dropped_since[job_id]

    def _forget(self, executor_ids: Collection[str]) -> None:
        """Remove workers that have stopped or died."""
        with self._database.begin() as connection:
            connection.execute(sa.delete(WORKERS).where(WORKERS.c.executor_id.in_(executor_ids)))
        for each in executor_ids:
            self._client.delete_queue(queue_of(each))
