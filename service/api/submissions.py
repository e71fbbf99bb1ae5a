"""Submit a picture: the checks, then the accepted job."""

from functools import partial
from typing import Any, Final

from fastapi import APIRouter, Request, Response
from starlette.concurrency import run_in_threadpool

from api_schemas.bodies import BodyRequest
from api_schemas.jobs import Job
from api_schemas.requests import FitOfImage, Person
from service.api.acceptance import (
    ACCEPTANCE_PROBLEMS,
    IdempotencyKey,
    Prefer,
    accept,
    accepted,
    answer,
    idempotency,
)
from service.api.context import ApiContext, Context
from service.api.images import image_content
from service.api.job_inputs import File, Inputs
from service.api.json_bodies import JSON, json_content, media_type, read_json_text
from service.api.problems import documented
from service.api.sandbox import asked_of_job
from service.api.uploads import Upload, read_upload
from service.estimates.messages import BodyTask
from service.jobs.inputs import IMAGE, MASK
from service.representation.jobs import represent
from service.submissions.detector import check_detector
from service.submissions.submission import CheckedSubmission, check_parts, check_submission
from service.submissions.validation import parsed
from service.webhooks.targets import check_webhook

ROUTER: Final = APIRouter(prefix="/v1/fits", tags=["fits"])

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
                            "description": "JPEG, PNG, WebP or HEIC.",
                        },
                        "request": {"$ref": "#/components/schemas/FitRequest"},
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
                    "image": {"contentType": "image/jpeg, image/png, image/webp, image/heic"},
                    "request": {"contentType": "application/json"},
                    "mask": {"contentType": "image/jpeg, image/png, image/webp, image/heic"},
                },
            },
            JSON: json_content(FitOfImage),
        },
    }
}


@ROUTER.post(
    "",
    status_code=202,
    response_model=Job,
    summary="Submit a picture",
    openapi_extra=_SUBMISSION,
    responses=accepted(Job)
    | documented(
        "malformed-request",
        "payload-too-large",
        "unsupported-media-type",
        "unusable-input",
        *ACCEPTANCE_PROBLEMS,
    ),
)
async def submit(
    request: Request,
    response: Response,
    context: Context,
    idempotency_key: IdempotencyKey = None,
    prefer: Prefer = None,
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
    contents = {IMAGE: upload.image} | ({} if upload.mask is None else {MASK: upload.mask})
    inputs = Inputs(
        options=checked.options.model_dump_json().encode(),
        files={
            name: File(content=content, media_type=checked.media_types[name])
            for name, content in contents.items()
        }
        | asked_of_job(context, checked.label),
        label=checked.label,
        webhook=checked.webhook,
    )
    job = await accept(
        context,
        context.jobs,
        inputs,
        key=idempotency(idempotency_key, upload.request, upload.image, upload.mask or b""),
        check=partial(refuse_nobody, context, checked.options),
    )
    return represent(await answer(context, context.jobs, response, job, prefer=prefer))


def _check(context: ApiContext, upload: Upload) -> CheckedSubmission:
    checked = check_submission(
        request=upload.request,
        image=upload.image,
        mask=upload.mask,
        max_pixels=context.settings.max_pixels,
    )
    check_webhook(checked.webhook, context.settings)
    check_detector(checked.options, context.settings.detector_dir)
    return checked


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
        asked, image=upload.image, mask=upload.mask, max_pixels=context.settings.max_pixels
    )
    check_webhook(checked.webhook, context.settings)
    check_detector(checked.options, context.settings.detector_dir)
    return checked, upload


async def refuse_nobody(context: ApiContext, person: Person) -> None:
    """Refuse early what the job would be refused for: measurements that no body combines."""
    if not person.measurements and person.weight_kg is None:
        return
    known = BodyRequest(
        gender=person.gender,
        height_m=person.height_m,
        weight_kg=person.weight_kg,
        measurements=person.measurements,
    )
    await context.estimates.refuse_nobody(BodyTask(request=known, with_glb=False))
