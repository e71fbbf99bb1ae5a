"""Submit a picture: the checks, the stored blobs, the accepted job."""

import contextlib
import hashlib
import re
import time
from typing import Annotated, Any, Final
from uuid import uuid4

from fastapi import APIRouter, Header, Request, Response
from starlette.concurrency import run_in_threadpool

from api_schemas.bodies import BodyRequest
from api_schemas.jobs import Job
from api_schemas.problems import problem
from api_schemas.requests import FitOfImage, FitOptions
from service.api.context import ApiContext, Context
from service.api.examples import FIT_OF_IMAGE
from service.api.images import image_content
from service.api.json_bodies import JSON, json_content, media_type, read_json_text
from service.api.problems import ProblemError, documented, not_found
from service.api.representation import POLL_AFTER_S, job_path, represent
from service.api.uploads import Upload, read_upload
from service.blobs import BlobsUnavailableError
from service.engine.port import (
    Idempotency,
    JobRecord,
    NewJob,
    StoredBlob,
    Submission,
    SubmitOutcome,
)
from service.estimates.messages import BodyTask
from service.jobs import ACTIVE
from service.submission import CheckedSubmission, check_parts, check_submission
from service.tracing import current_traceparent
from service.validation import parsed

ROUTER: Final = APIRouter(prefix="/v1/fits", tags=["fits"])

MAX_WAIT_S: Final = 60

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
            },
            JSON: json_content(FitOfImage, FIT_OF_IMAGE),
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
        "unusable-input",
        "idempotency-key-reused",
        "too-many-requests",
        "queue-full",
        "not-ready",
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

    The picture comes along, or was uploaded to `/v1/images` before: then the body is JSON and names
    it by `image_id`.

    The same `Idempotency-Key` with the same content answers with the earlier job. With
    `Prefer: wait=N` (at most 60 s) the answer waits for the job's end.
    """
    if media_type(request) == JSON:
        text = await read_json_text(request)
        checked, upload = await run_in_threadpool(_check_fit_of_image, context, text)
    else:
        upload = await read_upload(request)
        checked = await run_in_threadpool(_check, context, upload)
    job_id = str(uuid4())
    idempotency = _idempotency(idempotency_key, upload)
    # From here on the job's scope is erased by itself unless the job is accepted.
    submission = await run_in_threadpool(context.jobs.reserve, job_id, idempotency)
    if submission.outcome is SubmitOutcome.ACCEPTED:
        await _refuse_nobody(context, checked.options)
        submission = await run_in_threadpool(_store, context, job_id, upload, checked, idempotency)
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


def _check(context: ApiContext, upload: Upload) -> CheckedSubmission:
    return check_submission(
        request=upload.request,
        image=upload.image,
        mask=upload.mask,
        max_pixels=context.settings.max_pixels,
    )


def _check_fit_of_image(context: ApiContext, text: bytes) -> tuple[CheckedSubmission, Upload]:
    asked = parsed(FitOfImage, text, whole="body", called="the body")
    upload = Upload(
        request=text,
        image=image_content(context, asked.image_id, field="image_id"),
        mask=None
        if asked.mask_id is None
        else image_content(context, asked.mask_id, field="mask_id"),
    )
    checked = check_parts(
        FitOptions.model_construct(
            **{name: getattr(asked, name) for name in FitOptions.model_fields}
        ),
        image=upload.image,
        mask=upload.mask,
        max_pixels=context.settings.max_pixels,
    )
    return checked, upload


async def _refuse_nobody(context: ApiContext, options: FitOptions) -> None:
    """Refuse what the job would be refused for: measurements that nobody has together."""
    if not options.measurements and options.weight_kg is None:
        return
    known = BodyRequest(
        gender=options.gender,
        height_m=options.height_m,
        weight_kg=options.weight_kg,
        measurements=options.measurements,
    )
    await context.estimates.refuse_nobody(BodyTask(request=known, with_glb=False))


def _store(
    context: ApiContext,
    job_id: str,
    upload: Upload,
    checked: CheckedSubmission,
    idempotency: Idempotency | None,
) -> Submission:
    try:
        job = _stored(context, job_id, upload, checked, idempotency)
    except BlobsUnavailableError:
        _erase_at_once(context, job_id)
        raise
    # Should the database go away before it answers, it may have said yes: the blobs stay then.
    submission = context.jobs.submit(job)
    if submission.outcome is not SubmitOutcome.ACCEPTED:
        _erase_at_once(context, job_id)
    return submission


def _stored(
    context: ApiContext,
    job_id: str,
    upload: Upload,
    checked: CheckedSubmission,
    idempotency: Idempotency | None,
) -> NewJob:
    def stored(content: bytes, media_type: str) -> StoredBlob:
        return StoredBlob(digest=context.blobs.put(job_id, content), media_type=media_type)

    mask = None
    if upload.mask is not None and checked.mask_media_type is not None:
        mask = stored(upload.mask, checked.mask_media_type)
    return NewJob(
        id=job_id,
        options=stored(checked.options.model_dump_json().encode(), "application/json"),
        image=stored(upload.image, checked.image_media_type),
        mask=mask,
        idempotency=idempotency,
        request_id=context.request_id,
        traceparent=current_traceparent(),
    )


def _erase_at_once(context: ApiContext, job_id: str) -> None:
    # If this fails too, the sweep comes to it.
    with contextlib.suppress(BlobsUnavailableError):
        context.blobs.erase(job_id)


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
    if submission.outcome is SubmitOutcome.TENANT_FULL:
        raise ProblemError(
            problem(
                "too-many-requests",
                code="too-many-waiting",
                detail="Too many of your jobs are waiting already.",
                remedy="Try again when some of them have ended.",
            )
        )
    if submission.outcome is SubmitOutcome.LOST:
        raise ProblemError(
            problem(
                "not-ready",
                code="submission-lost",
                detail="The upload took too long and was given up.",
                remedy="Post the picture again.",
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
    while (
        job.state in ACTIVE
        and not context.feed.is_ending
        and (remaining_s := deadline - time.monotonic()) > 0
    ):
        await context.feed.wait_beyond(job.id, job.last_event, timeout_s=remaining_s)
        latest = await run_in_threadpool(context.jobs.job, job.id)
        if latest is None:
            raise not_found(what="such job any more")
        job = latest
    return job
