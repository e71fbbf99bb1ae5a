"""Fits as jobs: list, look at, cancel, erase."""

import re
from typing import Annotated, Any, Final
from uuid import UUID

from fastapi import APIRouter, Header, Query, Response

from api_schemas.jobs import Job, JobPage, JobState
from api_schemas.problems import FieldProblem, field_problem
from service.api.context import ApiContext, Context
from service.api.problems import ProblemError, documented, not_found
from service.api.representation import POLL_AFTER_S, represent
from service.engine.port import JobRecord
from service.jobs import ACTIVE, TERMINAL

ROUTER: Final = APIRouter(prefix="/v1/fits", tags=["fits"])

MAX_PAGE: Final = 200

CURSOR: Final = re.compile(
    r"^([0-9]{1,12}(?:\.[0-9]{1,9})?)-([0-9a-f]{8}-[0-9a-f]{4}-[0-9a-f]{4}-[0-9a-f]{4}-[0-9a-f]{12})$"
)
"""When the last job of a page was accepted, in epoch seconds, and its id."""


@ROUTER.get(
    "",
    response_model=JobPage,
    summary="List jobs, newest first",
    responses=documented("invalid-request", "not-ready", "internal-error"),
)
def list_fits(
    response: Response,
    context: Context,
    limit: Annotated[int, Query(ge=1, le=MAX_PAGE)] = 50,
    cursor: Annotated[
        str | None,
        Query(
            description="From `next` of the page before.",
            json_schema_extra={"pattern": CURSOR.pattern},
        ),
    ] = None,
    state: Annotated[JobState | None, Query()] = None,
) -> JobPage:
    """List jobs; `next` and the Link header lead to the following page."""
    before = None if cursor is None else _read_cursor(cursor)
    records = context.jobs.jobs(limit=limit + 1, before=before, state=state)
    page = records[:limit]
    following = None
    if len(records) > limit:
        following = f"/v1/fits?limit={limit}&cursor={_cursor(page[-1])}"
        following += f"&state={state}" if state else ""
        response.headers["Link"] = f'<{following}>; rel="next"'
    return JobPage(jobs=tuple(represent(record) for record in page), next=following)


@ROUTER.get(
    "/{fit_id}",
    response_model=Job,
    summary="Look at a job",
    responses={304: {"description": "Not changed since the given ETag."}}
    | documented("not-found", "fit-expired", "invalid-request", "not-ready", "internal-error"),
)
def get_fit(
    fit_id: UUID,
    response: Response,
    context: Context,
    if_none_match: Annotated[str | None, Header()] = None,
) -> Any:
    """Return where the job stands."""
    record = find(context, fit_id)
    tag = _tag(record)
    if if_none_match is not None and tag in if_none_match:
        return Response(status_code=304, headers={"ETag": tag})
    response.headers["ETag"] = tag
    response.headers["Cache-Control"] = "no-cache"
    if record.state in ACTIVE:
        response.headers["Retry-After"] = str(POLL_AFTER_S)
    return represent(record)


@ROUTER.post(
    "/{fit_id}/cancel",
    status_code=202,
    response_model=Job,
    summary="Cancel a job",
    responses={
        200: {"model": Job, "description": "The job has ended."},
        202: {"description": "The job is being stopped."},
    }
    | documented("not-found", "fit-expired", "invalid-request", "not-ready", "internal-error"),
)
def cancel(fit_id: UUID, response: Response, context: Context) -> Job:
    """Stop a job; canceling again, or canceling what has ended, changes nothing."""
    record = context.jobs.cancel(str(fit_id))
    if record is None:
        raise not_found(what="such job")
    if record.state in TERMINAL:
        response.status_code = 200
    return represent(record)


@ROUTER.delete(
    "/{fit_id}",
    status_code=204,
    summary="Erase a job",
    responses=documented(
        "not-found", "fit-expired", "invalid-request", "not-ready", "internal-error"
    ),
)
def erase(fit_id: UUID, context: Context) -> Response:
    """Stop the job if it runs, and erase its picture, intermediate files and results."""
    if not context.jobs.erase(str(fit_id)):
        raise not_found(what="such job")
    context.blobs.erase(str(fit_id))
    return Response(status_code=204)


def _tag(record: JobRecord) -> str:
    """An entity tag that changes with whatever is shown of the job."""
    parts = [record.last_event, int(record.cancel_requested)]
    if record.webhook is not None:
        parts += [record.webhook.state, record.webhook.attempts]
    return f'W/"{"-".join(map(str, parts))}"'


def find(context: ApiContext, fit_id: UUID) -> JobRecord:
    """Return the job or raise a 404."""
    record = context.jobs.job(str(fit_id))
    if record is None:
        raise not_found(what="such job")
    return record


def _cursor(record: JobRecord) -> str:
    return f"{record.created_at!r}-{record.id}"


def _read_cursor(cursor: str) -> tuple[float, str]:
    found = CURSOR.fullmatch(cursor)
    if found is None:
        raise ProblemError(
            field_problem(
                "invalid-request",
                FieldProblem(
                    field="cursor",
                    code="unknown-cursor",
                    reason="This is no cursor of this service.",
                    remedy="Follow 'next' of a page, or leave the cursor out.",
                ),
            )
        )
    return float(found[1]), found[2]
