"""Conversion between rows and records, and the statements both sides of the engine share."""

import time
from collections.abc import Callable, Mapping
from datetime import UTC, datetime
from typing import Any, Final

import sqlalchemy as sa
from pydantic import TypeAdapter

from api_schemas.jobs import EventData, EventKind, JobState
from api_schemas.problems import Problem
from api_schemas.results import ResultFile
from service.jobs.port import JobRecord, StoredBlob
from service.jobs.states import may_become
from service.jobs.statistics import count_ending
from service.jobs.tables import EVENTS, JOBS

JSON: Final = "application/json"
FILES: Final = TypeAdapter(tuple[ResultFile, ...])
INPUTS: Final = TypeAdapter(dict[str, StoredBlob])


# Written out once: putting a statement together takes longer than executing it.
_FIND: Final = sa.select(JOBS).where(JOBS.c.id == sa.bindparam("job"))
_APPEND: Final = sa.insert(EVENTS)


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


def find_job(connection: sa.Connection, job_id: str) -> JobRecord | None:
    """Return the job, or None if there is none."""
    row = connection.execute(_FIND, {"job": job_id}).mappings().one_or_none()
    return None if row is None else job_record(row)


def append_event(
    connection: sa.Connection,
    job: JobRecord,
    kind: EventKind,
    energies: Mapping[str, float] | None = None,
) -> None:
    """Append an event with the fit's current state, in the transaction that changed it.

    Products have none: what is asked of them is where they stand.
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
        _APPEND,
        {
            "job_id": job.id,
            "number": job.last_event,
            "kind": kind.value,
            "data": data.model_dump_json(),
        },
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


def end_job(
    connection: sa.Connection,
    job_id: str,
    *conditions: sa.ColumnElement[bool],
    state: JobState,
    retention_s: float,
    notify: Callable[[sa.Connection, JobRecord], None],
    values: Mapping[str, object] | None = None,
) -> JobRecord | None:
    """End a job like :func:`move_job`; it expires ``retention_s`` from now.

    If its creation is later than now, it expires ``retention_s`` from then: a clock that has been
    set back must not make the job expire the moment it is corrected. A product goes with its fit.
    ``notify`` has its end told, in the same transaction, if somebody asked for that.
    """
    now = time.time()
    latest = sa.case((JOBS.c.created_at > now, JOBS.c.created_at), else_=now)
    changes = {
        "finished_at": now,
        "expires_at": sa.case((JOBS.c.parent_id.is_(None), latest + retention_s)),
    }
    job = _change(connection, job_id, *conditions, state=state, values=changes | dict(values or {}))
    if job is not None:
        append_event(connection, job, EventKind.END)
        count_ending(connection, job)
        notify(connection, job)
    return job


def _change(
    connection: sa.Connection,
    job_id: str,
    *conditions: sa.ColumnElement[bool],
    state: JobState,
    values: Mapping[str, object],
) -> JobRecord | None:
    row = (
        connection.execute(
            sa.update(JOBS)
            .where(
                JOBS.c.id == job_id,
                JOBS.c.state.in_([source.value for source in may_become(state)]),
                *conditions,
            )
            .values(state=state.value, last_event=JOBS.c.last_event + 1, **values)
            .returning(JOBS)
        )
        .mappings()
        .one_or_none()
    )
    return None if row is None else job_record(row)
