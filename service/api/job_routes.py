"""What routes do with a job: find, show, list, cancel and erase."""

from collections.abc import Sequence
from typing import Annotated, Any, Final
from uuid import UUID

from fastapi import Header, Query, Response

from api_schemas.jobs import JobState
from api_schemas.labels import LabelOfList
from service.api.context import ApiContext
from service.api.listing import cursor_of, cursor_pattern, cursor_query, page_of, read_cursor
from service.api.problems import not_found
from service.api.storage import erase_blobs
from service.engine.port import JobRecord
from service.engine.tenant_jobs import TenantJobs
from service.jobs.states import ACTIVE, TERMINAL
from service.representation.jobs import POLL_AFTER_S, list_path

CURSOR: Final = cursor_pattern("[0-9a-f]{8}-[0-9a-f]{4}-[0-9a-f]{4}-[0-9a-f]{4}-[0-9a-f]{12}")
"""When the last job of a page was accepted, in epoch seconds, and its id."""

JOB_PROBLEMS: Final = (
    "not-found",
    "fit-expired",
    "invalid-request",
    "not-ready",
    "internal-error",
)
"""Problems that may keep a caller from a job."""

NOT_MODIFIED: Final[dict[int | str, dict[str, Any]]] = {
    304: {"description": "Not changed since the given ETag."}
}

Cursor = Annotated[str | None, cursor_query(CURSOR)]
State = Annotated[JobState | None, Query()]
OfLabel = Annotated[
    LabelOfList | None, Query(alias="label", description="Only those with exactly this label.")
]
IfNoneMatch = Annotated[str | None, Header()]


def find(jobs: TenantJobs, job_id: UUID) -> JobRecord:
    """Return the job or raise a 404."""
    record = jobs.job(str(job_id))
    if record is None:
        raise not_found(what="such job")
    return record


def not_modified(
    record: JobRecord, response: Response, if_none_match: str | None
) -> Response | None:
    """Return a 304 if the caller has the job's current state; else complete the headers."""
    tag = _tag(record)
    if if_none_match is not None and tag in if_none_match:
        return Response(status_code=304, headers={"ETag": tag})
    response.headers["ETag"] = tag
    if record.state in ACTIVE:
        response.headers["Retry-After"] = str(POLL_AFTER_S)
    return None


def jobs_page(
    jobs: TenantJobs,
    response: Response,
    *,
    limit: int,
    cursor: str | None,
    state: JobState | None,
    label: str | None,
) -> tuple[Sequence[JobRecord], str | None]:
    """Return a page of jobs, newest first, and the path of the next page."""
    before = read_cursor(CURSOR, cursor)
    records = jobs.jobs(limit=limit + 1, before=before, state=state, label=label)
    return page_of(
        records,
        response,
        path=list_path(records[0]) if records else "",
        limit=limit,
        cursor=lambda last: cursor_of(last.created_at, last.id),
        filters={"state": state, "label": label},
    )


def cancel_job(jobs: TenantJobs, job_id: UUID, response: Response) -> JobRecord:
    """Stop a job; 200 once it has ended."""
    record = jobs.cancel(str(job_id))
    if record is None:
        raise not_found(what="such job")
    if record.state in TERMINAL:
        response.status_code = 200
    return record


def erase_job(context: ApiContext, jobs: TenantJobs, job_id: UUID) -> Response:
    """Stop a job if it is running, and erase it with everything it holds."""
    scopes = jobs.erase(str(job_id))
    if not scopes:
        raise not_found(what="such job")
    erase_blobs(context.blobs, scopes)
    return Response(status_code=204)


def _tag(record: JobRecord) -> str:
    """An entity tag that changes with everything that is shown of the job."""
    parts = [record.last_event, int(record.cancel_requested)]
    if record.webhook is not None:
        parts += [record.webhook.state, record.webhook.attempts]
    return f'W/"{"-".join(map(str, parts))}"'
