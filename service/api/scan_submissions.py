"""Submit the pictures of a scan: the checks, then the accepted job."""

from functools import partial
from typing import Any, Final

from fastapi import APIRouter, Request, Response
from starlette.concurrency import run_in_threadpool

from api_schemas.scans import (
    MOST_VIEWS,
    Scan,
    ScanOfImages,
    ScanRequest,
    ScanViewOfImage,
)
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
from service.api.json_bodies import JSON, json_content, media_type, read_json_text, unsupported
from service.api.problems import documented
from service.api.sandbox import asked_of_job
from service.api.submissions import refuse_nobody
from service.api.uploads import MULTIPART, check_names, read_request_and_some
from service.engine.port import SCAN
from service.jobs.inputs import image_of, mask_of
from service.representation.jobs import represent_scan
from service.submissions.refusal import of_view
from service.submissions.scan_submission import ViewFiles, check_scan
from service.submissions.validation import parsed
from service.webhooks.targets import check_webhook

ROUTER: Final = APIRouter(prefix="/v1/scans", tags=["scans"])

_PICTURES: Final = "image/jpeg, image/png, image/webp, image/heic"
_IMAGES: Final = tuple(image_of(number) for number in range(MOST_VIEWS))
_MASKS: Final = tuple(mask_of(number) for number in range(MOST_VIEWS))


def _file(description: str) -> dict[str, str]:
    return {"type": "string", "format": "binary", "description": description}


_SUBMISSION: Final[dict[str, Any]] = {
    "requestBody": {
        "required": True,
        "content": {
            MULTIPART: {
                "schema": {
                    "type": "object",
                    "additionalProperties": False,
                    "required": ["request", *_IMAGES[:2]],
                    "properties": {"request": {"$ref": "#/components/schemas/ScanRequest"}}
                    | {
                        name: _file(f"The picture of view {number}: JPEG, PNG, WebP or HEIC.")
                        for number, name in enumerate(_IMAGES)
                    }
                    | {
                        name: _file(
                            f"A grey picture of the size of view {number}'s; the person is "
                            "brighter than half. Replaces the segmentation."
                        )
                        for number, name in enumerate(_MASKS)
                    },
                },
                "encoding": {"request": {"contentType": JSON}}
                | {name: {"contentType": _PICTURES} for name in (*_IMAGES, *_MASKS)},
            },
            JSON: json_content(ScanOfImages),
        },
    }
}


@ROUTER.post(
    "",
    status_code=202,
    response_model=Scan,
    summary="Submit pictures of one person",
    openapi_extra=_SUBMISSION,
    responses=accepted(Scan)
    | documented(
        "malformed-request",
        "payload-too-large",
        "unsupported-media-type",
        "unusable-input",
        *ACCEPTANCE_PROBLEMS,
    ),
)
async def submit_scan(
    request: Request,
    response: Response,
    context: Context,
    idempotency_key: IdempotencyKey = None,
    prefer: Prefer = None,
) -> Scan:
    """Accept pictures of one person, from the front and the side, say; the answer is a job.

    The pictures come along, `image_0` that of the first of the `views` and so on, or were uploaded
    to `/v1/images` before: then the body is JSON, and every view names its own by `image_id`.

    One body is found in all of them together. While it waits, a scan counts for as many jobs as it
    has pictures. `Idempotency-Key` and `Prefer` are as for fits.
    """
    if media_type(request) == JSON:
        text = await read_json_text(request)
        asked = parsed(ScanOfImages, text, whole="body", called="the body")
        sent = await run_in_threadpool(_uploaded, context, asked)
    elif media_type(request) == MULTIPART:
        text, parts = await read_request_and_some(request, (*_IMAGES, *_MASKS))
        asked = parsed(ScanRequest, text, whole="request", called="the part 'request'")
        sent = _sent_along(asked, parts)
    else:
        raise unsupported(
            request,
            remedy=(
                f"Send {MULTIPART} with the parts 'request', 'image_0' and 'image_1', or {JSON} "
                "with the image_id of an uploaded picture for every view."
            ),
            accepted=f"{MULTIPART}, {JSON}",
        )
    checked = await run_in_threadpool(
        check_scan,
        asked,
        sent,
        max_pixels=context.settings.max_pixels,
        detector=context.settings.detector_dir,
    )
    check_webhook(asked.webhook, context.settings)
    inputs = Inputs(
        kind=SCAN,
        options=checked.options.model_dump_json().encode(),
        files={
            name: File(content=file.content, media_type=file.media_type)
            for name, file in checked.files.items()
        }
        | asked_of_job(context, asked.label),
        pictures=len(sent),
        label=asked.label,
        webhook=asked.webhook,
    )
    contents = (content for each in sent for content in (each.image, each.mask or b""))
    job = await accept(
        context,
        context.scans,
        inputs,
        key=idempotency(idempotency_key, SCAN.encode(), text, *contents),
        check=partial(refuse_nobody, context, checked.options),
    )
    return represent_scan(await answer(context, context.scans, response, job, prefer=prefer))


def _sent_along(asked: ScanRequest, parts: dict[str, bytes]) -> tuple[ViewFiles, ...]:
    count = len(asked.views)
    check_names(parts, needed=_IMAGES[:count], known=("request", *_IMAGES[:count], *_MASKS[:count]))
    return tuple(
        ViewFiles(image=parts[image], mask=parts.get(mask))
        for image, mask in zip(_IMAGES[:count], _MASKS[:count], strict=True)
    )


def _uploaded(context: ApiContext, asked: ScanOfImages) -> tuple[ViewFiles, ...]:
    return tuple(_uploaded_view(context, number, view) for number, view in enumerate(asked.views))


def _uploaded_view(context: ApiContext, number: int, view: ScanViewOfImage) -> ViewFiles:
    with of_view(number):
        return ViewFiles(
            image=image_content(context, view.image_id, field="image_id"),
            mask=None
            if view.mask_id is None
            else image_content(context, view.mask_id, field="mask_id"),
        )
