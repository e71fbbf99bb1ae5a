"""How jobs ended and how long they took, counted where they end.

The counts are kept in the database and changed in the transaction that ends the job, so they miss
no job and count none twice, cover all machines, and outlive every process.
"""

import bisect
from collections.abc import Mapping
from typing import Final

import sqlalchemy as sa

from api_schemas.jobs import JobState
from service.jobs.port import FIT, DurationHistogram, JobRecord
from service.jobs.tables import DURATIONS, OUTCOMES
from service.jobs.transactions import insert_or_update

BOUNDS_S: Final = (0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 30.0, 60.0, 300.0, 1800.0, 1e9)
"""Upper bounds of the histograms' buckets, seconds; the last one stands for infinity."""

WAITING: Final = "waiting"
RUNNING: Final = "running"


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
    running = RUNNING if job.kind == FIT else f"{RUNNING}.{job.kind}"
    if job.started_at is not None and job.finished_at is not None:
        count_durations(
            connection,
            {
                WAITING: job.started_at - job.created_at,
                running: job.finished_at - job.started_at,
            },
        )


def count_durations(connection: sa.Connection, seconds: Mapping[str, float]) -> None:
    """Add one duration to the histogram of each phase."""
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
