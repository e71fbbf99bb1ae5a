"""Rows of jobs: read as records, and changed together with their events and the counts.

How jobs ended and how long they took is counted in the transaction that ends them: the counts miss
no job and count none twice, cover all machines, and outlive every process.
"""

import bisect
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any, Final

import sqlalchemy as sa
from pydantic import TypeAdapter

from api_schemas.jobs import EventData, EventKind, JobState
from api_schemas.problems import Problem
from api_schemas.results import ResultFile
from service.jobs.database import insert_or_update
from service.jobs.records import FIT, DurationHistogram, JobRecord, StoredBlob, may_become
from service.jobs.tables import DURATIONS, EVENTS, JOBS, OUTCOMES

JSON: Final = "application/json"
FILES: Final = TypeAdapter(tuple[ResultFile, ...])
INPUTS: Final = TypeAdapter(dict[str, StoredBlob])

BOUNDS_S: Final = (0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 30.0, 60.0, 300.0, 1800.0, 1e9)
"""Upper bounds of the histograms' buckets, seconds; the last one stands for infinity."""

WAITING: Final = "waiting"
RUNNING: Final = "running"


def job_record(values: sa.RowMapping) -> JobRecord:
    """Read a row of the jobs table."""
    return JobRecord(
        id=values["id"],
        tenant=values["tenant"],
        kind=values["kind"],
        parent=values["parent_id"],
        product=values["product"],
        state=JobState(values["state"]),
        stage=values["stage"],
        view=values["view"],
        progress=values["progress"],
        attempt=values["attempt"],
        cancel_requested=values["cancel_requested"],
        created_at=values["created_at"],
        started_at=values["started_at"],
        finished_at=values["finished_at"],
        expires_at=values["expires_at"],
        problem=None
        if values["problem"] is None
        else Problem.model_validate_json(values["problem"]),
        options=StoredBlob(digest=values["options_digest"], media_type=JSON),
        inputs=INPUTS.validate_json(values["inputs"]),
        pictures=values["pictures"],
        label=values["label"],
        result_files=FILES.validate_json(values["files"]),
        fingerprint=values["fingerprint"],
        request_id=values["request_id"],
        last_event=values["last_event"],
        webhook=None
        if values["webhook_target"] is None
        else StoredBlob(digest=values["webhook_target"], media_type=JSON),
    )


def job_where(connection: sa.Connection, *which: sa.ColumnElement[bool]) -> JobRecord | None:
    """Return the one job of which this holds, or None if there is none."""
    row = connection.execute(sa.select(JOBS).where(*which)).mappings().one_or_none()
    return None if row is None else job_record(row)


def find_job(connection: sa.Connection, job_id: str) -> JobRecord | None:
    """Return the job, or None if there is none."""
    return job_where(connection, JOBS.c.id == job_id)


def append_event(
    connection: sa.Connection,
    job: JobRecord,
    kind: EventKind,
    energies: Mapping[str, float] | None = None,
    *,
    before: int = 0,
) -> None:
    """Append an event with the fit's current state, in the transaction that changed it.

    It is the last one, or so many ``before`` it. Products have none: what is asked of them is where
    they stand.
    """
    if job.parent is not None:
        return
    data = EventData(
        state=job.state,
        stage=job.stage,
        view=job.view,
        progress=job.progress,
        energies=dict(energies or {}),
        at=datetime.now(UTC),
    )
    connection.execute(
        sa.insert(EVENTS).values(
            job_id=job.id,
            number=job.last_event - before,
            kind=kind.value,
            data=data.model_dump_json(),
        )
    )


def move_job(
    connection: sa.Connection,
    job_id: str,
    *conditions: sa.ColumnElement[bool],
    state: JobState,
    values: Mapping[str, object] | None = None,
) -> JobRecord | None:
    """Move a job to an active ``state`` if that is legal and the conditions hold.

    The check and the change are one statement, so that only one of two racing callers succeeds.
    Returns the changed job, or None if nothing was changed.
    """
    changes: dict[str, Any] = {}
    if state is JobState.RUNNING:
        changes["started_at"] = sa.func.coalesce(JOBS.c.started_at, time.time())
    job = _change(connection, job_id, *conditions, state=state, values=changes | dict(values or {}))
    if job is not None:
        append_event(connection, job, EventKind.STATE)
    return job


@dataclass(frozen=True, slots=True, kw_only=True)
class Endings:
    """Rules for ending jobs: the time until they expire, seconds, and who is told of their end.

    ``notify`` is called in the transaction that ends a job.
    """

    retention_s: float
    notify: Callable[[sa.Connection, JobRecord], None]

    def end(
        self,
        connection: sa.Connection,
        job_id: str,
        *conditions: sa.ColumnElement[bool],
        state: JobState,
        problem: Problem | None = None,
        values: Mapping[str, object] | None = None,
    ) -> JobRecord | None:
        """End a job like :func:`move_job`; it expires ``retention_s`` from now.

        If its creation is later than now, it expires ``retention_s`` from then: a clock that has
        been set back must not make the job expire the moment it is corrected. A product goes with
        its fit.
        """
        now = time.time()
        latest = sa.case((JOBS.c.created_at > now, JOBS.c.created_at), else_=now)
        changes = {
            "finished_at": now,
            "expires_at": sa.case((JOBS.c.parent_id.is_(None), latest + self.retention_s)),
            "problem": None if problem is None else problem.model_dump_json(),
        } | dict(values or {})
        job = _change(connection, job_id, *conditions, state=state, values=changes, events=2)
        if job is not None:
            append_event(connection, job, EventKind.STATE, before=1)
            append_event(connection, job, EventKind.END)
            count_ending(connection, job)
            self.notify(connection, job)
        return job


def _change(
    connection: sa.Connection,
    job_id: str,
    *conditions: sa.ColumnElement[bool],
    state: JobState,
    values: Mapping[str, object],
    events: int = 1,
) -> JobRecord | None:
    row = (
        connection.execute(
            sa.update(JOBS)
            .where(
                JOBS.c.id == job_id,
                JOBS.c.state.in_([source.value for source in may_become(state)]),
                *conditions,
            )
            .values(state=state.value, last_event=JOBS.c.last_event + events, **values)
            .returning(JOBS)
        )
        .mappings()
        .one_or_none()
    )
    return None if row is None else job_record(row)


def count_ending(connection: sa.Connection, job: JobRecord) -> None:
    """Count a job that has just ended, and how long it waited and ran.

    Running times of products are counted by kind, separately from those of fits.
    """
    insert = insert_or_update(connection, OUTCOMES).values(state=job.state.value, jobs=1)
    connection.execute(
        insert.on_conflict_do_update(
            index_elements=[OUTCOMES.c.state], set_={"jobs": OUTCOMES.c.jobs + 1}
        )
    )
    if job.started_at is None or job.finished_at is None:
        return
    running = RUNNING if job.kind == FIT else f"{RUNNING}.{job.kind}"
    seconds = {
        WAITING: job.started_at - job.created_at,
        running: job.finished_at - job.started_at,
    }
    # Always in the same order, so that two transactions cannot deadlock.
    for phase, duration in sorted(seconds.items()):
        # A clock that was set back can make a duration negative.
        lasted = min(max(duration, 0.0), BOUNDS_S[-1])
        bucket = BOUNDS_S[bisect.bisect_left(BOUNDS_S, lasted)]
        insert = insert_or_update(connection, DURATIONS).values(
            phase=phase, bucket=bucket, jobs=1, seconds=lasted
        )
        connection.execute(
            insert.on_conflict_do_update(
                index_elements=[DURATIONS.c.phase, DURATIONS.c.bucket],
                set_={
                    "jobs": DURATIONS.c.jobs + 1,
                    "seconds": DURATIONS.c.seconds + insert.excluded.seconds,
                },
            )
        )


def read_outcomes(connection: sa.Connection) -> dict[JobState, int]:
    """Return how many jobs have ever ended in each state."""
    return {JobState(row.state): row.jobs for row in connection.execute(sa.select(OUTCOMES))}


def read_durations(connection: sa.Connection) -> tuple[DurationHistogram, ...]:
    """Return the histogram of each phase that has one."""
    counts: dict[str, dict[float, int]] = {}
    totals: dict[str, float] = {}
    for row in connection.execute(sa.select(DURATIONS)):
        counts.setdefault(row.phase, {})[row.bucket] = row.jobs
        totals[row.phase] = totals.get(row.phase, 0.0) + row.seconds
    return tuple(
        DurationHistogram(
            phase=phase,
            counts=tuple((bound, counts[phase].get(bound, 0)) for bound in BOUNDS_S),
            seconds=totals[phase],
        )
        for phase in sorted(counts)
    )
