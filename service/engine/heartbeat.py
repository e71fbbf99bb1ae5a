"""A worker's heartbeat, and the recovery of fits whose worker died.

Open-source DBOS recovers a process's own jobs when it restarts under the same name. Our workers
never reuse a name, so each also watches the others: if one that holds running jobs is dead, its
jobs are put back into the queue.
"""

import logging
import threading
import time
from collections.abc import Callable, Collection
from typing import Final

import sqlalchemy as sa
from sqlalchemy.exc import OperationalError

from api_schemas.jobs import JobState
from api_schemas.problems import problem
from service.engine.attempts import given_up
from service.engine.executions import EXHAUSTED, Executions
from service.engine.liveness import WORKERS_SEEN, WorkerWatch, this_process
from service.engine.records import end_job
from service.engine.tables import JOBS, UNABLE_WORKERS, WORKERS
from service.engine.upsert import insert_or_update
from service.jobs.states import ACTIVE

LOG: Final = logging.getLogger(__name__)

RECONCILE_AFTER_S: Final = 5.0
"""How long a job may be recorded as active although its execution has ended: many times the time
between the last checkpoint and DBOS's own record of the end."""

RECONCILED_AT_ONCE: Final = 1_000
"""How many active jobs are checked per beat, starting with those that may have been claimed:
running ones, then those that have waited longest."""

DROPPED_AFTER_S: Final = 20.0
"""How long an execution may be recorded as run by a worker that does not run it. Putting one back
early does no harm: its record has ended, or its checkpoint is there."""


class Heartbeat:
    """A thread that beats, and recovers the fits of dead workers."""

    def __init__(
        self,
        database: sa.Engine,
        *,
        executor_id: str,
        interval_s: float,
        dead_after_s: float,
        retention_s: float,
        executions: Executions,
        recover: Callable[[Collection[str]], object],
        put_back: Callable[[str], object],
        holds: Callable[[], Collection[str]],
        is_able: Callable[[], bool],
    ) -> None:
        self._database = database
        self._executor_id = executor_id
        self._interval_s = interval_s
        self._retention_s = retention_s
        self._executions = executions
        self._recover = recover
        self._put_back = put_back
        self._holds = holds
        self._is_able = is_able
        self._watch = WorkerWatch(dead_after_s=dead_after_s)
        self._process = this_process()
        self._stopped = threading.Event()
        self._ended_since: dict[str, float] = {}
        self._dropped_since: dict[str, float] = {}
        self._thread = threading.Thread(target=self._run, name="heartbeat", daemon=True)

    def register(self) -> None:
        """Make this worker known, before it claims anything."""
        self._beat()

    def start(self) -> None:
        """Begin to beat and to watch the others: DBOS must be running by now."""
        self._thread.start()

    def stop(self) -> None:
        """Stop beating and sign off, so that nobody waits for this worker."""
        self._stopped.set()
        self._thread.join()
        with self._database.begin() as connection:
            _forget(connection, [self._executor_id])

    def _run(self) -> None:
        while True:
            try:
                self._beat()
                # In this order: a worker makes itself known before it claims anything.
                holders = self._executions.holders()
                self._take_over(set(holders.values()))
                self._pick_up(
                    {job for job, holder in holders.items() if holder == self._executor_id}
                )
                self._reconcile()
            except OperationalError as error:
                LOG.warning("The database is not available (%s).", error.orig)
            except Exception:
                # The database may be unavailable and come back; the heartbeat must never stop.
                LOG.exception("A heartbeat failed.")
            if self._stopped.wait(self._interval_s):
                return

    def _beat(self) -> None:
        with self._database.begin() as connection:
            beaten = connection.execute(
                sa.update(WORKERS)
                .where(WORKERS.c.executor_id == self._executor_id)
                .values(beat=WORKERS.c.beat + 1)
            )
            if beaten.rowcount == 0:
                # The first beat, or the others took this worker for dead and removed it.
                connection.execute(
                    sa.insert(WORKERS).values(
                        executor_id=self._executor_id,
                        machine=self._process.machine,
                        pid=self._process.pid,
                        pid_started=self._process.pid_started,
                        beat=0,
                        started_at=time.time(),
                    )
                )
            if self._is_able():
                own = UNABLE_WORKERS.c.executor_id == self._executor_id
                connection.execute(sa.delete(UNABLE_WORKERS).where(own))
            else:
                connection.execute(
                    insert_or_update(connection, UNABLE_WORKERS)
                    .values(executor_id=self._executor_id)
                    .on_conflict_do_nothing()
                )

    def _take_over(self, holders: set[str]) -> None:
        with self._database.connect() as connection:
            workers = connection.execute(WORKERS_SEEN).all()
        alive = self._watch.alive(workers) | {self._executor_id}
        dead = sorted(holders - alive)
        if dead:
            LOG.warning("Taking over the fits of %s.", ", ".join(dead))
            self._recover(dead)
        gone = [row.executor_id for row in workers if row.executor_id not in alive]
        if gone:
            with self._database.begin() as connection:
                _forget(connection, gone)

    def _pick_up(self, pending: set[str]) -> None:
        """Put back what is recorded as run by this worker but is not: its thread ended in an error.

        That happens when DBOS itself cannot write what a fit returned, the disk being full.
        """
        now = time.monotonic()
        dropped = pending - set(self._holds())
        self._dropped_since = {each: self._dropped_since.get(each, now) for each in dropped}
        for job_id, since in list(self._dropped_since.items()):
            if now - since >= DROPPED_AFTER_S:
                LOG.warning("job=%s was dropped by this worker and is put back.", job_id)
                self._put_back(job_id)
                del self._dropped_since[job_id]

    def _reconcile(self) -> None:
        """End the records of jobs whose execution DBOS gave up on, so that none waits forever."""
        query = (
            sa.select(JOBS.c.id)
            .where(JOBS.c.state.in_([state.value for state in ACTIVE]))
            .order_by(JOBS.c.state == JobState.QUEUED.value, JOBS.c.created_at)
            .limit(RECONCILED_AT_ONCE)
        )
        with self._database.connect() as connection:
            active = connection.execute(query).scalars().all()
        ended = self._executions.ended(active)
        now = time.monotonic()
        self._ended_since = {job_id: self._ended_since.get(job_id, now) for job_id in ended}
        for job_id, since in self._ended_since.items():
            if now - since >= RECONCILE_AFTER_S:
                self._give_up(job_id, ended[job_id])

    def _give_up(self, job_id: str, status: str) -> None:
        LOG.error("Job %s was left %s by its execution; it is ended here.", job_id, status)
        reason = (
            given_up("Every worker that took this job died over it.")
            if status == EXHAUSTED
            else problem(
                "fit-failed",
                detail="The fit's execution ended without a result.",
                remedy="Post the picture again.",
            )
        )
        with self._database.begin() as connection:
            end_job(
                connection,
                job_id,
                state=JobState.FAILED,
                retention_s=self._retention_s,
                values={"problem": reason.model_dump_json()},
            )


def _forget(connection: sa.Connection, executor_ids: Collection[str]) -> None:
    """Remove workers that have stopped or died."""
    for table in (WORKERS, UNABLE_WORKERS):
        connection.execute(sa.delete(table).where(table.c.executor_id.in_(executor_ids)))
