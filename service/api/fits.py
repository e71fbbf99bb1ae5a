"""Fits: list, look at, follow, cancel and erase them; their requests, results and files."""

from collections.abc import AsyncIterator
from datetime import UTC, datetime
from typing import Annotated, Final
from uuid import UUID

from fastapi import APIRouter, Depends, Query, Response
from fastapi.responses import StreamingResponse

from api_schemas.fit import FitRequest
from api_schemas.jobs import Fit, FitLinks, FitPage, JobState
from api_schemas.labels import Label
from api_schemas.problems import Problem, problem
from api_schemas.results import FitResult
from service.api.context import Context
from service.api.events import EVENT_ANSWERS, LastEventId, event_stream, too_many_streams
from service.api.files import (
    FORMATS,
    NOT_MODIFIED,
    PICTURES,
    FileName,
    Wanted,
    answer_file,
    as_stored,
    chosen_rendition,
    file_answers,
)
from service.api.listing import Cursor, Limit, page_of, read_cursor
from service.api.problems import ProblemError, documented, not_found
from service.api.requests import JSON, json_content
from service.api.storage import erase_blobs, writing
from service.jobs.engine import TenantJobs
from service.jobs.inputs import RESULT
from service.jobs.records import ACTIVE, TERMINAL, JobRecord

FITS: Final = "/v1/fits"
"""Path of the fits below the service's root."""

POLL_AFTER_S: Final = 1
"""Value of Retry-After for a fit that has not ended, seconds."""

ROUTER: Final = APIRouter(prefix=FITS, tags=["fits"])

FIT_PROBLEMS: Final = ("not-found", "fit-expired")
"""Problems that may keep a caller from a fit."""


def _tenants_fits(context: Context) -> TenantJobs:
    return context.jobs


def _found(fit_id: UUID, jobs: Annotated[TenantJobs, Depends(_tenants_fits)]) -> JobRecord:
    return find(jobs, fit_id)


Found = Annotated[JobRecord, Depends(_found)]
"""The fit that the path names; 404 where there is none."""


async def _place(context: Context) -> AsyncIterator[None]:
    with context.feed.place(context.tenant) as has_place:
        if not has_place:
            raise too_many_streams()
        yield


Place = Annotated[None, Depends(_place, scope="request")]
"""A place of the owner's, from before the answer to its end; 429 where all are taken."""


def find(jobs: TenantJobs, fit_id: UUID) -> JobRecord:
    """Return the fit or raise a 404."""
    record = jobs.job(str(fit_id))
    if record is None:
        raise not_found(what="such fit")
    return record


@ROUTER.get(
    "",
    response_model=FitPage,
    summary="List fits, newest first",
)
def list_fits(
    context: Context,
    response: Response,
    limit: Limit = 50,
    cursor: Cursor = None,
    state: Annotated[JobState | None, Query()] = None,
    label: Annotated[Label | None, Query(description="Only those with exactly this label.")] = None,
) -> FitPage:
    """List fits; `next` and the Link header lead to the following page."""
    before = read_cursor(cursor)
    page, following = page_of(
        context.jobs.jobs(limit=limit + 1, before=before, state=state, label=label),
        response,
        path=FITS,
        limit=limit,
        filters={"state": state, "label": label},
    )
    return FitPage(fits=tuple(map(represent, page)), next=following)


@ROUTER.get(
    "/{fit_id}",
    response_model=Fit,
    summary="Look at a fit",
    responses=documented(*FIT_PROBLEMS),
)
def get_fit(record: Found, response: Response) -> Fit:
    """Return where the fit stands."""
    if record.state in ACTIVE:
        response.headers["Retry-After"] = str(POLL_AFTER_S)
    return represent(record)


@ROUTER.get(
    "/{fit_id}/events",
    summary="Follow a fit",
    response_class=StreamingResponse,
    responses=EVENT_ANSWERS | documented(*FIT_PROBLEMS),
)
def follow_fit(
    record: Found, context: Context, _place: Place, last_event_id: LastEventId = None
) -> Response:
    """Stream state changes, stages, progress and energies; `view` says of which picture.

    All events since the fit was accepted are kept: a client that comes late or reconnects misses
    none.
    """
    return event_stream(context.feed, context.jobs, record, last_event_id)


@ROUTER.post(
    "/{fit_id}/cancel",
    status_code=202,
    response_model=Fit,
    summary="Cancel a fit",
    responses={
        200: {"model": Fit, "description": "The fit has ended."},
        202: {"description": "The fit is being stopped."},
    }
    | documented(*FIT_PROBLEMS),
)
async def cancel_fit(fit_id: UUID, context: Context, response: Response) -> Fit:
    """Stop a fit; canceling again, or canceling what has ended, changes nothing."""
    record = await writing(context.jobs.cancel, str(fit_id))
    if record is None:
        raise not_found(what="such fit")
    if record.state in TERMINAL:
        response.status_code = 200
    return represent(record)


@ROUTER.delete(
    "/{fit_id}", status_code=204, summary="Erase a fit", responses=documented(*FIT_PROBLEMS)
)
async def erase_fit(fit_id: UUID, context: Context) -> Response:
    """Stop the fit if it runs, and erase it with its pictures, results and products."""
    if not await writing(context.jobs.erase, str(fit_id)):
        raise not_found(what="such fit")
    await erase_blobs(context.blobs, [str(fit_id)])
    return Response(status_code=204)


@ROUTER.get(
    "/{fit_id}/request",
    summary="The request of a fit",
    response_class=Response,
    responses={
        200: {
            "description": "As it was understood, defaults included.",
            "content": {JSON: json_content(FitRequest)},
        },
    }
    | NOT_MODIFIED
    | documented(*FIT_PROBLEMS),
)
async def get_fit_request(record: Found, context: Context, wanted: Wanted) -> Response:
    """Return what was asked for, with names for all points: to be changed and sent again."""
    return await answer_file(context, record.id, as_stored(record.options), wanted)


@ROUTER.get(
    "/{fit_id}/result",
    summary="The result document of a fit",
    responses={200: {"model": FitResult}} | NOT_MODIFIED | documented("no-result", *FIT_PROBLEMS),
)
async def get_fit_result(record: Found, context: Context, wanted: Wanted) -> Response:
    """Return measurements, cameras, pose, shape, light, what was assumed, and the files' names."""
    document = record.files.get(RESULT)
    if record.state is not JobState.SUCCEEDED or document is None:
        raise ProblemError(no_result(record))
    return await answer_file(context, record.id, as_stored(document), wanted)


@ROUTER.get(
    "/{fit_id}/files/{name:path}",
    summary="A file of a fit",
    description="Return a file: `views/0/image`, as it was sent; `views/0/overlay.png`, "
    f"`body_canonical.obj`, `measurements.csv` and so on.{FORMATS}",
    response_class=Response,
    responses=file_answers(*PICTURES, "application/zip", problems=FIT_PROBLEMS),
)
async def get_fit_file(record: Found, name: FileName, context: Context, wanted: Wanted) -> Response:
    """Return a file."""
    rendition = chosen_rendition(record.files, name, state=record.state, accept=wanted.accept)
    return await answer_file(context, record.id, rendition, wanted)


def no_result(record: JobRecord) -> Problem:
    """Say why a fit has no result."""
    if record.problem is not None:
        return problem(
            "no-result",
            code=record.problem.code,
            field=record.problem.field,
            detail=f"The fit {record.state}: {record.problem.detail}",
            remedy=record.problem.remedy,
        )
    canceled = record.state is JobState.CANCELED
    return problem(
        "no-result",
        detail=f"The fit is {record.state}.",
        remedy="Send it again." if canceled else "Wait until it has succeeded; follow its events.",
    )


def fit_path(fit_id: str) -> str:
    """Path of a fit below the service's root."""
    return f"{FITS}/{fit_id}"


def represent(record: JobRecord) -> Fit:
    """Translate a record."""
    return Fit(
        id=UUID(record.id),
        state=record.state,
        stage=record.stage,
        view=record.view,
        progress=record.progress,
        attempt=record.attempt,
        cancel_requested=record.cancel_requested,
        created_at=_moment(record.created_at),
        started_at=None if record.started_at is None else _moment(record.started_at),
        finished_at=None if record.finished_at is None else _moment(record.finished_at),
        expires_at=None if record.expires_at is None else _moment(record.expires_at),
        problem=record.problem,
        label=record.label,
        links=_links(record),
    )


def _links(record: JobRecord) -> FitLinks:
    path = fit_path(record.id)
    succeeded = record.state is JobState.SUCCEEDED
    return FitLinks(
        self=path,
        events=f"{path}/events",
        request=f"{path}/request",
        cancel=f"{path}/cancel" if record.state in ACTIVE else None,
        result=f"{path}/result" if succeeded else None,
        products=f"{path}/products" if succeeded else None,
        files={name: f"{path}/files/{name}" for name in record.files},
    )


def _moment(seconds: float) -> datetime:
    return datetime.fromtimestamp(seconds, UTC)
