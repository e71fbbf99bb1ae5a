"""Rows to records and back, and the statements both sides of the engine share."""

import time
from collections.abc import Mapping
from datetime import UTC, datetime
from typing import Any, Final

import sqlalchemy as sa
from pydantic import TypeAdapter

from api_schemas.jobs import EventData, EventKind, JobState
from api_schemas.problems import Problem
from api_schemas.results import Artifact
from service.engine.port import JobRecord, StoredBlob
from service.engine.tables import EVENTS, JOBS
from service.jobs import TERMINAL, may_become

ARTIFACTS: Final = TypeAdapter(tuple[Artifact, ...])


def job_record(values: sa.RowMapping) -> JobRecord:
    """Read a row of the jobs table."""
    return JobRecord(
        id=values["id"],
        state=JobState(values["state"]),
        stage=values["stage"],
        progress=values["progress"],
        attempt=values["attempt"],
        cancel_requested=values["cancel_requested"],
        created_at=values["created_at"],
        started_at=values["started_at"],
        finished_at=values["finished_at"],
        problem=None
        if values["problem"] is None
        else Problem.model_validate_json(values["problem"]),
        options=values["options"],
        image=StoredBlob(digest=values["image_digest"], media_type=values["image_media_type"]),
        mask=None
        if values["mask_digest"] is None
        else StoredBlob(digest=values["mask_digest"], media_type=values["mask_media_type"]),
        artifacts=ARTIFACTS.validate_json(values["artifacts"]),
        fingerprint=values["fingerprint"],
        last_event=values["last_event"],
    )


def find_job(connection: sa.Connection, job_id: str) -> JobRecord | None:
    """Return the job, or None if there is none."""
    row = connection.execute(sa.select(JOBS).where(JOBS.c.id == job_id)).mappings().one_or_none()
    return None if row is None else job_record(row)


def append_event(
    connection: sa.Connection,
    job: JobRecord,
    kind: EventKind,
    energies: Mapping[str, float] | None = None,
) -> None:
    """Append an event that shows the job as it is, in the transaction that made it so."""
    data = EventData(
        state=job.state,
        stage=job.stage,
        progress=job.progress,
        energies=dict(energies or {}),
        at=datetime.now(UTC),
    )
    connection.execute(
        sa.insert(EVENTS).values(
            job_id=job.id, number=job.last_event, kind=kind.value, data=data.model_dump_json()
        )
    )


def change_job(
    connection: sa.Connection,
    job_id: str,
    *conditions: sa.ColumnElement[bool],
    state: JobState,
    values: Mapping[str, object] | None = None,
) -> JobRecord | None:
    """Move a job to ``state`` if that is legal and the conditions hold, and append the event.

    The check and the change are one statement, so that of two racing callers one loses. Returns
    the changed job, or None if nothing was changed.
    """
    now = time.time()
    changes: dict[str, Any] = {"state": state.value, "last_event": JOBS.c.last_event + 1}
    if state in TERMINAL:
        changes["finished_at"] = now
    if state is JobState.RUNNING:
        changes["started_at"] = sa.func.coalesce(JOBS.c.started_at, now)
    row = (
        connection.execute(
            sa.update(JOBS)
            .where(
                JOBS.c.id == job_id,
                JOBS.c.state.in_([source.value for source in may_become(state)]),
                *conditions,
            )
            .values(**(changes | dict(values or {})))
            .returning(JOBS)
        )
        .mappings()
        .one_or_none()
    )
    if row is None:
        return None
    job = job_record(row)
    append_event(connection, job, EventKind.END if state in TERMINAL else EventKind.STATE)
    return job
