"""Scans as jobs: list, look at, follow, cancel, erase, repeat; what they were made of and found."""

from typing import Annotated, Any, Final
from uuid import UUID

from fastapi import APIRouter, Path, Response
from fastapi.responses import StreamingResponse
from starlette.concurrency import run_in_threadpool

from api_schemas.scans import MOST_VIEWS, Scan, ScanPage, ScanResult
from service.api.acceptance import IdempotencyKey, Prefer, accepted
from service.api.artifacts import (
    NEGOTIATION,
    AcceptHeader,
    ArtifactName,
    IfRange,
    RangeHeader,
    answer_artifact,
    file_answers,
)
from service.api.context import Context
from service.api.events import EVENT_ANSWERS, LastEventId, event_stream
from service.api.fit_inputs import (
    AS_JPEG,
    AS_SENT,
    PICTURE_ANSWERS,
    UNDERSTOOD,
    serve_blob,
    serve_picture,
)
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
from service.api.json_bodies import JSON
from service.api.problems import documented, not_found
from service.api.results import serve_result
from service.api.retries import RETRY_PROBLEMS, accept_again
from service.engine.port import SCAN
from service.jobs.inputs import image_of, mask_of
from service.representation.jobs import collection_path, represent_scan

ROUTER: Final = APIRouter(prefix="/v1/scans", tags=["scans"])

ViewNumber = Annotated[
    int, Path(ge=0, lt=MOST_VIEWS, description="The view's place in the request, from 0 on.")
]


@ROUTER.get(
    "",
    response_model=ScanPage,
    summary="List scans, newest first",
    responses=documented("invalid-request", "not-ready", "internal-error"),
)
def list_scans(
    response: Response,
    context: Context,
    limit: Limit = 50,
    cursor: Cursor = None,
    state: State = None,
    label: OfLabel = None,
) -> ScanPage:
    """List jobs; `next` and the Link header lead to the following page."""
    page, following = page_of(
        context.scans,
        response,
        path=collection_path(SCAN),
        limit=limit,
        cursor=cursor,
        state=state,
        label=label,
    )
    return ScanPage(scans=tuple(represent_scan(record) for record in page), next=following)


@ROUTER.get(
    "/{scan_id}",
    response_model=Scan,
    summary="Look at a scan",
    responses=NOT_MODIFIED | documented(*JOB_PROBLEMS),
)
def get_scan(
    scan_id: UUID, response: Response, context: Context, if_none_match: IfNoneMatch = None
) -> Any:
    """Return where the job stands, and which of its pictures it is at."""
    record = find(context.scans, scan_id)
    return not_modified(record, response, if_none_match) or represent_scan(record)


@ROUTER.post(
    "/{scan_id}/cancel",
    status_code=202,
    response_model=Scan,
    summary="Cancel a scan",
    responses={
        200: {"model": Scan, "description": "The job has ended."},
        202: {"description": "The job is being stopped."},
    }
    | documented(*JOB_PROBLEMS),
)
def cancel_scan(scan_id: UUID, response: Response, context: Context) -> Scan:
    """Stop a job; canceling again, or canceling what has ended, changes nothing."""
    return represent_scan(cancel_job(context.scans, scan_id, response))


@ROUTER.post(
    "/{scan_id}/retry",
    status_code=202,
    response_model=Scan,
    summary="Measure the same pictures again",
    responses=accepted(Scan) | documented(*RETRY_PROBLEMS),
)
async def retry_scan(
    scan_id: UUID,
    response: Response,
    context: Context,
    idempotency_key: IdempotencyKey = None,
    prefer: Prefer = None,
) -> Scan:
    """Accept a new job on the pictures and the request of one that has ended.

    It has copies of its own of all, and its notice goes where the first one's went.
    """
    return represent_scan(
        await accept_again(
            context, context.scans, scan_id, response, key=idempotency_key, prefer=prefer
        )
    )


@ROUTER.delete(
    "/{scan_id}",
    status_code=204,
    summary="Erase a scan",
    responses=documented(*JOB_PROBLEMS),
)
def erase_scan(scan_id: UUID, context: Context) -> Response:
    """Stop the job if it runs, and erase all its pictures, intermediate files and results.

    What was derived from it is stopped and erased too.
    """
    return erase_job(context, context.scans, scan_id)


@ROUTER.get(
    "/{scan_id}/events",
    summary="Follow a scan",
    response_class=StreamingResponse,
    responses=EVENT_ANSWERS,
)
def follow_scan(scan_id: UUID, context: Context, last_event_id: LastEventId = None) -> Response:
    """Stream state changes, stages and progress as for fits; `view` says of which picture."""
    return event_stream(context, context.scans, scan_id, last_event_id)


@ROUTER.get(
    "/{scan_id}/request",
    summary="The request of a scan",
    response_class=Response,
    responses={
        200: {
            "description": UNDERSTOOD,
            "content": {JSON: {"schema": {"$ref": "#/components/schemas/ScanOptions"}}},
        },
    }
    | NOT_MODIFIED
    | documented(*JOB_PROBLEMS),
)
def scan_request(scan_id: UUID, context: Context, if_none_match: IfNoneMatch = None) -> Response:
    """Return what was asked for, points by name: to be changed and sent again."""
    record = find(context.scans, scan_id)
    return serve_blob(context, record, record.options, if_none_match)


@ROUTER.get(
    "/{scan_id}/views/{number}/image",
    summary="The picture of a view",
    description=f"Return the picture as it was sent; it is erased with the scan.{AS_JPEG}",
    response_class=Response,
    responses=PICTURE_ANSWERS,
)
async def scan_image(
    scan_id: UUID,
    number: ViewNumber,
    context: Context,
    if_none_match: IfNoneMatch = None,
    accept: AcceptHeader = None,
) -> Response:
    """Return the picture as it was sent, or as a JPEG."""
    record = await run_in_threadpool(find, context.scans, scan_id)
    if image_of(number) not in record.inputs:
        raise not_found(what=f"view: this scan has {record.pictures}")
    image = record.inputs[image_of(number)]
    return await serve_picture(context, record, image, if_none_match, accept)


@ROUTER.get(
    "/{scan_id}/views/{number}/mask",
    summary="The mask of a view",
    response_class=Response,
    responses=AS_SENT | NOT_MODIFIED | documented(*JOB_PROBLEMS),
)
def scan_mask(
    scan_id: UUID, number: ViewNumber, context: Context, if_none_match: IfNoneMatch = None
) -> Response:
    """Return the mask as it was sent; `not-found` if none was."""
    record = find(context.scans, scan_id)
    if mask_of(number) not in record.inputs:
        raise not_found(what="mask: this view was sent none")
    return serve_blob(context, record, record.inputs[mask_of(number)], if_none_match)


@ROUTER.get(
    "/{scan_id}/result",
    summary="The result document of a scan",
    responses={200: {"model": ScanResult}} | NOT_MODIFIED | documented("no-result", *JOB_PROBLEMS),
)
def scan_result(scan_id: UUID, context: Context, if_none_match: IfNoneMatch = None) -> Response:
    """Return shape, measurements, every view's camera, pose and light, and the files' names."""
    return serve_result(context, find(context.scans, scan_id), if_none_match=if_none_match)


@ROUTER.get(
    "/{scan_id}/artifacts/{name}",
    summary="A file of a scan",
    description="Return a file: `body_canonical.glb`, `overlay_0.png` and so on, as the job's "
    f"links name them, or `body_canonical.obj`, `measurements.csv` and so on.{NEGOTIATION}",
    response_class=Response,
    responses=file_answers("image/png", "application/zip"),
)
async def scan_artifact(
    scan_id: UUID,
    name: ArtifactName,
    context: Context,
    if_none_match: IfNoneMatch = None,
    range_header: RangeHeader = None,
    if_range: IfRange = None,
    accept: AcceptHeader = None,
) -> Response:
    """Return a file, a part of it, or the same mesh in another format."""
    return await answer_artifact(
        context,
        context.scans,
        scan_id,
        name,
        accept=accept,
        range_header=range_header,
        if_range=if_range,
        if_none_match=if_none_match,
    )
