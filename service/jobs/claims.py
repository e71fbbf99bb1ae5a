"""Which jobs a worker runs: those whose records say so, in ``claimed_by``.

A job that has not ended and is claimed by nobody waits for a worker. Claiming, putting back and
taking over are one transaction each, so that of two workers only one succeeds.
"""

from collections.abc import Collection
from typing import Final

import sqlalchemy as sa

from api_schemas.jobs import JobState
from api_schemas.problems import problem
from service.jobs.attempts import given_up
from service.jobs.database import read_then_write
from service.jobs.records import ACTIVE
from service.jobs.rows import Endings
from service.jobs.tables import JOBS

MAX_WORKER_DEATHS: Final = 10
"""Number of workers that may die while running one job. Larger than the limit on crashes of the
fit's own process, because workers also die for reasons unrelated to the picture: restarts,
machines, chaos tests."""

_ACTIVE: Final = JOBS.c.state.in_([state.value for state in ACTIVE])
_RUNNING: Final = JOBS.c.state == JobState.RUNNING.value
_DEATHS: Final = sa.func.coalesce(JOBS.c.worker_deaths, 0)
_WAITING: Final = sa.select(JOBS.c.id).where(_ACTIVE, JOBS.c.claimed_by.is_(None))


class Claims:
    """The claims of one worker."""

    def __init__(self, database: sa.Engine, *, executor_id: str, endings: Endings) -> None:
        self._database = database
        self._executor_id = executor_id
        self._endings = endings
        self._own = sa.and_(_ACTIVE, JOBS.c.claimed_by == executor_id)

    def take(self, most: int) -> list[str]:
        """Claim up to ``most`` waiting jobs, those first whose turn is first."""
        with self._database.connect() as connection:
            # Usually there is none, which spares SQLite a write transaction.
            if connection.execute(_WAITING.limit(1)).first() is None:
                return []
        first = _WAITING.order_by(JOBS.c.turn, JOBS.c.created_at).limit(most)
        with read_then_write(self._database) as connection:
            jobs = list(connection.execute(first.with_for_update(skip_locked=True)).scalars())
            connection.execute(
                sa.update(JOBS).where(JOBS.c.id.in_(jobs)).values(claimed_by=self._executor_id)
            )
        return jobs

    def held(self) -> set[str]:
        """The jobs that this worker has claimed and that have not ended."""
        with self._database.connect() as connection:
            return set(connection.execute(sa.select(JOBS.c.id).where(self._own)).scalars())

    def holders(self) -> set[str]:
        """By which workers, dead or alive, jobs are claimed that have not ended."""
        query = sa.select(JOBS.c.claimed_by).where(_ACTIVE, JOBS.c.claimed_by.is_not(None))
        with self._database.connect() as connection:
            return set(connection.execute(query.distinct()).scalars())

    def waiting_or_held(self, jobs: Collection[str]) -> set[str]:
        """Which of these jobs have not ended."""
        query = sa.select(JOBS.c.id).where(_ACTIVE, JOBS.c.id.in_(jobs))
        with self._database.connect() as connection:
            return set(connection.execute(query).scalars())

    def put_back(self, job_id: str) -> None:
        """Let a job of this worker wait again."""
        with self._database.begin() as connection:
            connection.execute(
                sa.update(JOBS).where(self._own, JOBS.c.id == job_id).values(claimed_by=None)
            )

    def give_up(self, job_id: str) -> None:
        """End a job of this worker whose execution ended in an error."""
        reason = problem(
            "fit-failed",
            detail="The fit's execution ended without a result.",
            remedy="Post the picture again.",
        )
        with self._database.begin() as connection:
            self._endings.end(connection, job_id, state=JobState.FAILED, problem=reason)

    def take_from(self, dead: Collection[str]) -> list[str]:
        """Let the jobs of dead workers wait again, and end those over which too many have died.

        Of several workers that notice a death, the first does this. Returns the jobs.
        """
        with read_then_write(self._database) as connection:
            rows = connection.execute(
                sa.update(JOBS)
                .where(_ACTIVE, JOBS.c.claimed_by.in_(dead))
                .values(claimed_by=None, worker_deaths=_DEATHS + sa.case((_RUNNING, 1), else_=0))
                .returning(JOBS.c.id, JOBS.c.worker_deaths)
            ).all()
            for row in rows:
                if row.worker_deaths > MAX_WORKER_DEATHS:
                    reason = given_up("Every worker that took this job died over it.")
                    self._endings.end(connection, row.id, state=JobState.FAILED, problem=reason)
        return [row.id for row in rows]
