"""Submit one to six pictures of a person: read, check, store, and have a fit accepted."""

import hashlib
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Annotated, Final
from uuid import uuid4

from fastapi import APIRouter, Header, Request, Response
from starlette.concurrency import run_in_threadpool

from api_schemas.fit import MOST_VIEWS, FitRequest
from api_schemas.jobs import Fit, WebhookTarget
from api_schemas.problems import Problem, problem
from service.api.context import ApiContext, Context
from service.api.events import Prefer, wait_for_end
from service.api.fits import FITS, POLL_AFTER_S, fit_path, represent
from service.api.images import image_content
from service.api.problems import ProblemError, documented, not_found, problem_error
from service.api.requests import (
    JSON,
    MULTIPART,
    REQUEST,
    Part,
    body,
    form_content,
    json_part,
    read_json_or_form,
)
from service.api.storage import disk_full, erase_at_once, store, storing, with_blobs, writing
from service.jobs.inputs import IMAGE, MASK, SentPicture
from service.jobs.notices import target_fault
from service.jobs.records import (
    ACTIVE,
    FIT,
    Idempotency,
    JobRecord,
    NewJob,
    Submission,
    SubmitOutcome,
)
from service.submissions.refusal import of_view, refused, refused_field
from service.submissions.submission import CheckedSubmission, check_detector, check_submission

ROUTER: Final = APIRouter(prefix=FITS, tags=["fits"])

_PARTS: Final = {
    REQUEST: json_part(FitRequest),
    IMAGE: Part(
        description="A picture: JPEG, PNG, WebP or HEIC. None where all were uploaded.",
        most=MOST_VIEWS,
    ),
    MASK: Part(
        description="A grey picture of its picture's size; the person is brighter than half. One "
        "for each picture; replaces segmentation.",
        most=MOST_VIEWS,
    ),
}

TO_FOLLOW: Final = {
    "Location": {"description": "Where to look at it.", "schema": {"type": "string"}},
    "Retry-After": {"description": "Seconds to wait.", "schema": {"type": "integer"}},
}
"""Headers of an answer that comes before the end."""

IdempotencyKey = Annotated[
    str | None,
    Header(
        min_length=1,
        max_length=255,
        description="The same key with the same content answers with the earlier job.",
    ),
]


@ROUTER.post(
    "",
    status_code=202,
    response_model=Fit,
    summary="Submit pictures",
    openapi_extra=body(form=form_content(_PARTS)),
    responses={
        200: {"model": Fit, "description": "Ended within the time of `Prefer: wait`."},
        202: {"description": "Accepted.", "headers": TO_FOLLOW},
    }
    | documented("idempotency-key-reused", "insufficient-storage"),
)
async def submit_fit(
    request: Request,
    response: Response,
    context: Context,
    idempotency_key: IdempotencyKey = None,
    prefer: Prefer = None,
) -> Fit:
    """Accept one to six pictures of a person; the answer is a fit to follow.

    The pictures come along, in the order of `views`, or were uploaded to `/v1/images` before: then
    every view names its `image_id`, and the JSON of `request` alone may be the body. One body is
    found in all of them together. While it waits, a fit counts for as many as it has pictures.

    The same `Idempotency-Key` with the same content answers with the earlier fit. With `Prefer:
    wait=N` (at most 60 s) the answer waits for the fit's end.
    """
    received = await read_json_or_form(request, FitRequest, _PARTS)
    asked = received.asked
    if received.files:
        sent = _sent_along(asked, received.files.get(IMAGE, ()), received.files.get(MASK, ()))
    else:
        sent = await with_blobs(context.blobs, _uploaded, context, asked)
    checked = await run_in_threadpool(_checked, context, asked, sent)
    contents = (content for each in sent for content in (each.image, each.mask or b""))
    key = _idempotency(idempotency_key, received.text, *contents)
    fit = await _accept(context, checked, asked.webhook, key=key)
    look = partial(context.jobs.job, fit.id)
    fit = await wait_for_end(
        context.feed, context.tenant, fit, look, prefer=prefer, response=response
    )
    response.headers["Location"] = fit_path(fit.id)
    if fit.state in ACTIVE:
        response.headers["Retry-After"] = str(POLL_AFTER_S)
    elif "Preference-Applied" in response.headers:
        response.status_code = 200
    return represent(fit)


def _sent_along(
    asked: FitRequest, images: Sequence[bytes], masks: Sequence[bytes]
) -> tuple[SentPicture[bytes], ...]:
    for number, view in enumerate(asked.views):
        if view.image_id is not None or view.mask_id is not None:
            raise refused_field(
                field=f"views.{number}.{'mask_id' if view.image_id is None else 'image_id'}",
                code="one-picture-needed",
                reason="The pictures come with the request.",
                remedy="Leave it out, or send the request alone, as JSON.",
            )
    if not masks:
        return tuple(SentPicture(image, None) for image in images)
    if len(masks) != len(images):
        raise refused_field(
            field="mask",
            code="views-count",
            reason=f"{len(images)} pictures came, and {len(masks)} masks.",
            remedy="Send no mask, or one for each picture, in their order.",
        )
    return tuple(SentPicture(image, mask) for image, mask in zip(images, masks, strict=True))


def _uploaded(context: ApiContext, asked: FitRequest) -> tuple[SentPicture[bytes], ...]:
    pictures = []
    for number, view in enumerate(asked.views):
        with of_view(number):
            if view.image_id is None:
                raise refused_field(
                    field="image_id",
                    code="missing",
                    reason="The picture is missing.",
                    remedy=f"Send the id of an uploaded picture, or {MULTIPART} with the "
                    "parts 'request' and 'image'.",
                )
            image = image_content(context, view.image_id, field="image_id")
            mask = None
            if view.mask_id is not None:
                mask = image_content(context, view.mask_id, field="mask_id")
        pictures.append(SentPicture(image, mask))
    return tuple(pictures)


def _checked(
    context: ApiContext, asked: FitRequest, sent: Sequence[SentPicture[bytes]]
) -> CheckedSubmission:
    checked = check_submission(
        asked, sent, max_pixels=context.settings.max_pixels, read=context.read_header
    )
    fault = None if asked.webhook is None else target_fault(asked.webhook, context.settings)
    if fault is not None:
        raise refused(fault)
    check_detector(asked, context.settings.detector_dir)
    return checked


async def _accept(
    context: ApiContext,
    checked: CheckedSubmission,
    webhook: WebhookTarget | None,
    *,
    key: Idempotency | None,
) -> JobRecord:
    """Have a fit accepted, or return the earlier one with the same key.

    Raises
    ------
    ProblemError
        If the fit is not accepted.
    """
    fit_id = str(uuid4())
    with storing():
        # From here on the fit's scope is erased automatically unless the fit is accepted.
        submission = await writing(_reserve, context, fit_id, checked, key)
        if submission.outcome is SubmitOutcome.ACCEPTED:
            submission = await with_blobs(
                context.blobs, _store, context, fit_id, checked, webhook, key
            )
    return accepted_job(submission)


def _idempotency(key: str | None, *parts: bytes) -> Idempotency | None:
    """Hash a caller's key and the parts of the request that came with it."""
    if key is None:
        return None
    digest = hashlib.sha256()
    for part in parts:
        digest.update(hashlib.sha256(part).digest())
    return Idempotency(key=hashlib.sha256(key.encode()).hexdigest(), fingerprint=digest.hexdigest())


def _reserve(
    context: ApiContext, fit_id: str, checked: CheckedSubmission, key: Idempotency | None
) -> Submission:
    size = sum(len(file.content) for file in checked.files.values())
    if context.disk.has_room_for(len(_options(checked)) + size):
        return context.jobs.submissions.reserve(fit_id, key)
    # Not even the scope is recorded; but repeating an earlier answer takes no space.
    repeated = context.jobs.submissions.repeated(key)
    if repeated is None:
        raise disk_full()
    return repeated


def _store(
    context: ApiContext,
    fit_id: str,
    checked: CheckedSubmission,
    webhook: WebhookTarget | None,
    key: Idempotency | None,
) -> Submission:
    """Store all inputs in the fit's scope, one file after the other, and submit it."""
    asked = checked.request
    stored = partial(store, context.blobs, fit_id)
    try:
        job = NewJob(
            id=fit_id,
            kind=FIT,
            options=stored(_options(checked), JSON),
            inputs={
                name: stored(file.content, file.media_type) for name, file in checked.files.items()
            },
            # While it waits it counts for as many fits.
            pictures=len(asked.views),
            label=asked.label,
            idempotency=key,
            request_id=context.request_id,
            webhook=None if webhook is None else stored(webhook.model_dump_json().encode(), JSON),
        )
    except Exception:
        erase_at_once(context.blobs, fit_id)
        raise
    # If the database goes away before it answers, it may have accepted the job: the blobs stay.
    submission = context.jobs.submissions.submit(job)
    if submission.outcome is not SubmitOutcome.ACCEPTED:
        erase_at_once(context.blobs, fit_id)
    return submission


def _options(checked: CheckedSubmission) -> bytes:
    return checked.request.model_dump_json().encode()


_REFUSALS: Final[Mapping[SubmitOutcome, Problem]] = {
    SubmitOutcome.QUEUE_FULL: problem(
        "queue-full",
        detail="The queue of waiting jobs is full.",
        remedy="Try again after the time in Retry-After.",
    ),
    SubmitOutcome.TENANT_FULL: problem(
        "too-many-requests",
        code="too-many-waiting",
        detail="Too many of your jobs are waiting already.",
        remedy="Try again when some of them have ended.",
    ),
    SubmitOutcome.LOST: problem(
        "not-ready",
        code="submission-lost",
        detail="The upload took too long and was given up.",
        remedy="Post it again.",
    ),
}


def accepted_job(submission: Submission) -> JobRecord:
    """Return the job that was accepted, now or earlier.

    Raises
    ------
    ProblemError
        If none was.
    """
    if submission.outcome in _REFUSALS:
        raise ProblemError(_REFUSALS[submission.outcome])
    if submission.outcome is SubmitOutcome.FIT_GONE:
        raise not_found(what="such fit any more")
    if submission.job is None:
        raise problem_error(
            slug="idempotency-key-reused",
            detail="This Idempotency-Key came earlier with another request.",
            remedy="Use a new key for every new request.",
            field="Idempotency-Key",
        )
    return submission.job
