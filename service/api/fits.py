"""Fits as jobs: submit, list, look at, cancel, erase."""

import base64
import binascii
import hashlib
import re
import time
from typing import Annotated, Any, Final
from uuid import UUID, uuid4

from fastapi import APIRouter, Header, Query, Request, Response
from starlette.concurrency import run_in_threadpool

from api_schemas.jobs import Job, JobPage, JobState
from api_schemas.problems import FieldProblem, field_problem, problem
from service.api.context import ApiContext, Context
from service.api.problems import ProblemError, documented, not_found
from service.api.representation import job_path, represent
from service.api.uploads import Upload, read_upload
from service.engine.port import (
    Idempotency,
    JobRecord,
    NewJob,
    StoredBlob,
    Submission,
    SubmitOutcome,
)
from service.jobs import ACTIVE, TERMINAL
from service.submission import check_submission

ROUTER: Final = APIRouter(prefix="/v1/fits", tags=["fits"])

POLL_AFTER_S: Final = 1
MAX_WAIT_S: Final = 60
MAX_PAGE: Final = 200

_SUBMISSION: Final[dict[str, Any]] = {
    "requestBody": {
        "required": True,
        "content": {
            "multipart/form-data": {
                "schema": {
                    "type": "object",
                    "additionalProperties": False,
                    "required": ["image", "request"],
                    "properties": {
                        "image": {
                            "type": "string",
                            "format": "binary",
                            "description": "JPEG, PNG or WebP.",
                        },
                        "request": {"$ref": "#/components/schemas/FitOptions"},
                        "mask": {
                            "type": "string",
                            "format": "binary",
                            "description": (
                                "A grey picture of the same size; the person is brighter than "
                                "half. Replaces the segmentation."
                            ),
                        },
                    },
                },
                "encoding": {
                    "image": {"contentType": "image/jpeg, image/png, image/webp"},
                    "request": {"contentType": "application/json"},
                    "mask": {"contentType": "image/jpeg, image/png, image/webp"},
                },
            }
        },
    }
}

_ACCEPTED_HEADERS: Final = {
    "Location": {"description": "Path of the job.", "schema": {"type": "string"}},
    "Retry-After": {"description": "Seconds to wait.", "schema": {"type": "integer"}},
}


@ROUTER.post(
    "",
    status_code=202,
    response_model=Job,
    summary="Submit a picture",
    openapi_extra=_SUBMISSION,
    responses={
        200: {"model": Job, "description": "Ended within the time of `Prefer: wait`."},
        202: {"description": "Accepted.", "headers": _ACCEPTED_HEADERS},
    }
    | documented(
        "malformed-request",
        "payload-too-large",
        "unsupported-media-type",
        "invalid-request",
        "idempotency-key-reused",
        "queue-full",
        "internal-error",
    ),
)
async def submit(
    request: Request,
    response: Response,
    context: Context,
    idempotency_key: Annotated[str | None, Header(min_length=1, max_length=255)] = None,
    prefer: Annotated[str | None, Header(description="`respond-async` or `wait=N`.")] = None,
) -> Job:
    """Accept a picture with its points; the answer is a job to follow.

    The same `Idempotency-Key` with the same content answers with the earlier job. With
    `Prefer: wait=N` (at most 60 s) the answer waits for the job's end.
    """
    upload = await read_upload(request)
    submission = await run_in_threadpool(_store, context, upload, idempotency_key)
    job = _accepted(submission)
    wait_s = _preferred_wait_s(prefer)
    if wait_s > 0:
        job = await _wait_for_end(context, job, wait_s)
        response.headers["Preference-Applied"] = f"wait={wait_s}"
    response.headers["Location"] = job_path(job.id)
    if job.state in ACTIVE:
        response.headers["Retry-After"] = str(POLL_AFTER_S)
    elif wait_s > 0:
        response.status_code = 200
    return represent(job)


@ROUTER.get(
    "",
    response_model=JobPage,
    summary="List jobs, newest first",
    responses=documented("invalid-request", "internal-error"),
)
def list_fits(
    response: Response,
    context: Context,
    limit: Annotated[int, Query(ge=1, le=MAX_PAGE)] = 50,
    cursor: Annotated[str | None, Query(description="From `next` of the page before.")] = None,
    state: Annotated[JobState | None, Query()] = None,
) -> JobPage:
    """List jobs; `next` and the Link header lead to the following page."""
    before = None if cursor is None else _read_cursor(cursor)
    records = context.engine.jobs(limit=limit + 1, before=before, state=state)
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
    | documented("not-found", "invalid-request", "internal-error"),
)
def get_fit(
    fit_id: UUID,
    response: Response,
    context: Context,
    if_none_match: Annotated[str | None, Header()] = None,
) -> Any:
    """Return where the job stands."""
    record = find(context, fit_id)
    tag = f'W/"{record.last_event}-{int(record.cancel_requested)}"'
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
    | documented("not-found", "invalid-request", "internal-error"),
)
def cancel(fit_id: UUID, response: Response, context: Context) -> Job:
    """Stop a job; canceling again, or canceling what has ended, changes nothing."""
    record = context.engine.cancel(str(fit_id))
    if record is None:
        raise not_found(what="such job")
    if record.state in TERMINAL:
        response.status_code = 200
    return represent(record)


@ROUTER.delete(
    "/{fit_id}",
    status_code=204,
    summary="Erase a job",
    responses=documented("not-found", "invalid-request", "internal-error"),
)
def erase(fit_id: UUID, context: Context) -> Response:
    """Stop the job if it runs, and erase its picture, intermediate files and results."""
    if not context.engine.erase(str(fit_id)):
        raise not_found(what="such job")
    context.blobs.erase(str(fit_id))
    return Response(status_code=204)


def find(context: ApiContext, fit_id: UUID) -> JobRecord:
    """Return the job or raise a 404."""
    record = context.engine.job(str(fit_id))
    if record is None:
        raise not_found(what="such job")
    return record


def _store(context: ApiContext, upload: Upload, idempotency_key: str | None) -> Submission:
    checked = check_submission(
        request=upload.request,
        image=upload.image,
        mask=upload.mask,
        max_pixels=context.settings.max_pixels,
    )
    job_id = str(uuid4())
    blobs = context.blobs
    image = StoredBlob(digest=blobs.put(job_id, upload.image), media_type=checked.image_media_type)
    mask = None
    if upload.mask is not None and checked.mask_media_type is not None:
        mask = StoredBlob(digest=blobs.put(job_id, upload.mask), media_type=checked.mask_media_type)
    accepted = False
    try:
        submission = context.engine.submit(
            NewJob(
                id=job_id,
                options=checked.options.model_dump_json(),
                image=image,
                mask=mask,
                idempotency=_idempotency(idempotency_key, upload),
            )
        )
        accepted = submission.outcome is SubmitOutcome.ACCEPTED
    finally:
        if not accepted:
            blobs.erase(job_id)
    return submission


def _idempotency(key: str | None, upload: Upload) -> Idempotency | None:
    if key is None:
        return None
    digest = hashlib.sha256()
    for part in (upload.request, upload.image, upload.mask or b""):
        digest.update(hashlib.sha256(part).digest())
    return Idempotency(key=hashlib.sha256(key.encode()).hexdigest(), fingerprint=digest.hexdigest())


def _accepted(submission: Submission) -> JobRecord:
    if submission.outcome is SubmitOutcome.QUEUE_FULL:
        raise ProblemError(
            problem(
                "queue-full",
                detail="The queue of waiting jobs is full.",
                remedy="Try again after the time in Retry-After.",
            )
        )
    if submission.job is None:
        raise ProblemError(
            problem(
                "idempotency-key-reused",
                detail="This Idempotency-Key came earlier with another request.",
                remedy="Use a new key for every new request.",
                field="Idempotency-Key",
            )
        )
    return submission.job


def _preferred_wait_s(prefer: str | None) -> int:
    found = re.search(r"(?:^|[,;\s])wait\s*=\s*(\d{1,6})", prefer or "")
    return min(int(found[1]), MAX_WAIT_S) if found else 0


async def _wait_for_end(context: ApiContext, job: JobRecord, wait_s: int) -> JobRecord:
    deadline = time.monotonic() + wait_s
    while job.state in ACTIVE and (remaining_s := deadline - time.monotonic()) > 0:
        await context.feed.wait_beyond(job.id, job.last_event, timeout_s=remaining_s)
        latest = await run_in_threadpool(context.engine.job, job.id)
        if latest is None:
            raise not_found(what="such job any more")
        job = latest
    return job


def _cursor(record: JobRecord) -> str:
    return base64.urlsafe_b64encode(f"{record.created_at!r}/{record.id}".encode()).decode()


def _read_cursor(cursor: str) -> tuple[float, str]:
    try:
        created_at, _, job_id = base64.urlsafe_b64decode(cursor.encode()).decode().partition("/")
        return float(created_at), str(UUID(job_id))
    except (ValueError, binascii.Error) as error:
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
        ) from error
