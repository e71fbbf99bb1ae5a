"""Fits as jobs: list, look at, cancel, erase."""

from typing import Any, Final
from uuid import UUID

from fastapi import APIRouter, Response

from api_schemas.jobs import Job, JobPage
from service.api.context import Context
from service.api.job_routes import (
    JOB_PROBLEMS,
    NOT_MODIFIED,
    Cursor,
    IfNoneMatch,
    Limit,
    OfLabel,
    State,
    cancel_job,
    erase_job,
    find,
    not_modified,
    page_of,
)
from service.api.problems import documented
from service.representation.jobs import represent

ROUTER: Final = APIRouter(prefix="/v1/fits", tags=["fits"])


@ROUTER.get(
    "",
    response_model=JobPage,
    summary="List jobs, newest first",
    responses=documented("invalid-request", "not-ready", "internal-error"),
)
def list_fits(
    response: Response,
    context: Context,
    limit: Limit = 50,
    cursor: Cursor = None,
    state: State = None,
    label: OfLabel = None,
) -> JobPage:
    """List jobs; `next` and the Link header lead to the following page."""
    page, following = page_of(
        context.jobs,
        response,
        path="/v1/fits",
        limit=limit,
        cursor=cursor,
        state=state,
        label=label,
    )
    return JobPage(jobs=tuple(represent(record) for record in page), next=following)


@ROUTER.get(
    "/{fit_id}",
    response_model=Job,
    summary="Look at a job",
    responses=NOT_MODIFIED | documented(*JOB_PROBLEMS),
)
def get_fit(
    fit_id: UUID, response: Response, context: Context, if_none_match: IfNoneMatch = None
) -> Any:
    """Return where the job stands."""
    record = find(context.jobs, fit_id)
    return not_modified(record, response, if_none_match) or represent(record)


@ROUTER.post(
    "/{fit_id}/cancel",
    status_code=202,
    response_model=Job,
    summary="Cancel a job",
    responses={
        200: {"model": Job, "description": "The job has ended."},
        202: {"description": "The job is being stopped."},
    }
    | documented(*JOB_PROBLEMS),
)
def cancel(fit_id: UUID, response: Response, context: Context) -> Job:
    """Stop a job; canceling again, or canceling what has ended, changes nothing."""
    return represent(cancel_job(context.jobs, fit_id, response))


@ROUTER.delete(
    "/{fit_id}",
    status_code=204,
    summary="Erase a job",
    responses=documented(*JOB_PROBLEMS),
)
def erase(fit_id: UUID, context: Context) -> Response:
    """Stop the job if it runs, and erase its picture, intermediate files and results.

    What was derived from it is stopped and erased too.
    """
    return erase_job(context, context.jobs, fit_id)
