"""The worker's access to a job's record: begin an attempt, report, end it.

Every write names the attempt it belongs to. A worker that was taken for dead and wakes up again
finds that its attempt is no longer the current one, and none of its writes have any effect.
"""

import logging
import time
from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Final

import sqlalchemy as sa
from pydantic import TypeAdapter

from api_schemas.jobs import EventKind, JobState
from api_schemas.problems import Problem, problem
from service.jobs.database import (
    ABSENCES,
    SCHEMA_FACT,
    retry_while_database_is_away,
    touch_fact,
)
from service.jobs.records import AttemptResult, Directive, JobRecord, Report
from service.jobs.rows import (
    FILES,
    Endings,
    append_event,
    find_job,
    job_record,
    move_job,
)
from service.jobs.tables import JOBS
from service.process.retrying import LONGEST_PAUSE_S

LOG: Final = logging.getLogger(__name__)


def given_up(reason: str) -> Problem:
    """Say that a job was given up because it kills the processes that run it."""
    return problem(
        "fit-crashed",
        detail=reason,
        remedy="Save the picture anew as PNG and try again; if that fails too, report it.",
    )


class Attempt:
    """One execution of a job, as the one who runs it sees it."""

    def __init__(
        self, database: sa.Engine, job: JobRecord, *, leave_slot: Callable[[str], None]
    ) -> None:
        self._database = database
        self._leave_slot = leave_slot
        self.job: Final = job
        """The job as it was when the attempt began."""
        self.is_current: Final = (
            JOBS.c.id == job.id,
            JOBS.c.state == JobState.RUNNING.value,
            JOBS.c.attempt == job.attempt,
        )

    @retry_while_database_is_away
    def report(self, report: Report) -> Directive:
        """Store progress and its event, and say whether to continue; the share never decreases."""
        share = sa.case((JOBS.c.progress > report.progress, JOBS.c.progress), else_=report.progress)
        reported = (
            sa.update(JOBS)
            .where(*self.is_current)
            .values(
                stage=report.stage,
                view=report.view,
                progress=share,
                last_event=JOBS.c.last_event + 1,
            )
            .returning(JOBS)
        )
        with self._database.begin() as connection:
            row = connection.execute(reported).mappings().one_or_none()
            if row is None:
                return Directive.SUPERSEDED
            job = job_record(row)
            append_event(connection, job, EventKind.PROGRESS, report.energies)
        return Directive.CANCELED if job.cancel_requested else Directive.CONTINUE

    @retry_while_database_is_away
    def directive(self) -> Directive:
        """Ask whether the attempt is still wanted."""
        query = sa.select(JOBS.c.cancel_requested).where(*self.is_current)
        with self._database.connect() as connection:
            cancel_requested = connection.execute(query).scalar_one_or_none()
        if cancel_requested is None:
            return Directive.SUPERSEDED
        return Directive.CANCELED if cancel_requested else Directive.CONTINUE

    def leave_slot(self) -> None:
        """Let another job begin: all that is left of this one is to store its result."""
        self._leave_slot(self.job.id)


AttemptHandler = Callable[[Attempt], AttemptResult]


class AttemptLog:
    """Begin and end attempts on behalf of one worker."""

    def __init__(
        self,
        database: sa.Engine,
        *,
        executor_id: str,
        max_crashes: int,
        endings: Endings,
        leave_slot: Callable[[str], None],
    ) -> None:
        self._database = database
        self._executor_id = executor_id
        self._max_crashes = max_crashes
        self._endings = endings
        self._leave_slot = leave_slot

    @retry_while_database_is_away
    def begin(self, job_id: str) -> Attempt | None:
        """Claim the next attempt; None if there is nothing (more) to do for this job."""
        with self._database.begin() as connection:
            job = move_job(
                connection,
                job_id,
                JOBS.c.cancel_requested.is_(False),
                JOBS.c.crashes < self._max_crashes,
                state=JobState.RUNNING,
                values={
                    "attempt": JOBS.c.attempt + 1,
                    "claimed_by": self._executor_id,
                    "stage": None,
                    "view": None,
                    "progress": 0.0,
                },
            )
            if job is None:
                self._end_unbegun(connection, job_id)
                return None
        return Attempt(self._database, job, leave_slot=self._leave_slot)

    def _end_unbegun(self, connection: sa.Connection, job_id: str) -> None:
        """End a job that is not to be begun, unless it has ended."""
        is_canceled = JOBS.c.cancel_requested.is_(True)
        canceled = self._endings.end(connection, job_id, is_canceled, state=JobState.CANCELED)
        if canceled is None:
            self._endings.end(
                connection,
                job_id,
                JOBS.c.crashes >= self._max_crashes,
                state=JobState.FAILED,
                problem=given_up(f"The process of this job died {self._max_crashes} times."),
            )

    @retry_while_database_is_away
    def count_crash(self, attempt: Attempt) -> None:
        """Note that the process of this attempt died without being killed by us."""
        counted = sa.update(JOBS).values(crashes=JOBS.c.crashes + 1)
        with self._database.begin() as connection:
            connection.execute(counted.where(*attempt.is_current))

    @retry_while_database_is_away
    def end(self, job_id: str, attempt: int, result: AttemptResult) -> JobRecord | None:
        """Publish the result; None if the attempt was superseded or the job erased."""
        state = JobState(result.ending.value)
        complete = {"progress": 1.0} if state is JobState.SUCCEEDED else {}
        with self._database.begin() as connection:
            return self._endings.end(
                connection,
                job_id,
                JOBS.c.attempt == attempt,
                state=state,
                problem=result.problem,
                values={"files": FILES.dump_json(result.files).decode(), **complete},
            )

    def await_database(self) -> None:
        """Return once the database takes writes.

        DBOS repeats its own writes after pauses that double up to a minute and a half: what it is
        given to write while the database is away or full stands still for long afterwards.
        """
        while True:
            try:
                with self._database.begin() as connection:
                    touch_fact(connection, SCHEMA_FACT)
                    return
            except ABSENCES as error:
                LOG.warning(
                    "The database is not available (%s); waiting.", getattr(error, "orig", error)
                )
            time.sleep(LONGEST_PAUSE_S)

    @retry_while_database_is_away
    def exists(self, job_id: str) -> bool:
        """Whether the job still exists, not having been erased."""
        with self._database.connect() as connection:
            return find_job(connection, job_id) is not None

    @retry_while_database_is_away
    def hand_back(self) -> None:
        """Let this worker's jobs wait again, as if they had not been begun."""
        is_own = JOBS.c.claimed_by == self._executor_id
        running = sa.select(JOBS.c.id).where(is_own, JOBS.c.state == JobState.RUNNING.value)
        claimed = sa.update(JOBS).where(is_own, JOBS.c.state == JobState.QUEUED.value)
        with self._database.begin() as connection:
            for job_id in list(connection.execute(running).scalars()):
                move_job(
                    connection,
                    job_id,
                    is_own,
                    state=JobState.QUEUED,
                    values={"claimed_by": None, "stage": None, "view": None, "progress": 0.0},
                )
            # Those that have not begun.
            connection.execute(claimed.values(claimed_by=None))


@dataclass(frozen=True, slots=True, kw_only=True)
class Computed(AttemptResult):
    """A result that has yet to be published: of which attempt, and where its files lie."""

    attempt: int
    scope: str


COMPUTED: Final = TypeAdapter(Computed)
"""The form of a checkpoint; see :data:`service.jobs.executions.EXECUTION_VERSION`."""


def checkpoint(job: JobRecord, result: AttemptResult) -> str:
    """Write the result of a job's attempt in the form kept in the checkpoint."""
    told = {each.name: getattr(result, each.name) for each in fields(AttemptResult)}
    return COMPUTED.dump_json(Computed(attempt=job.attempt, scope=job.scope, **told)).decode()
