"""Submit one to six pictures of a person: checks, then a fit."""

from collections.abc import Sequence
from functools import partial
from typing import Any, Final

from fastapi import APIRouter, Request, Response
from starlette.concurrency import run_in_threadpool

from api_schemas.fit import MOST_VIEWS, FitRequest
from api_schemas.jobs import Fit
from api_schemas.problems import FieldProblem
from api_schemas.questions import BodyRequest
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
from service.api.fit_inputs import File, Inputs
from service.api.images import image_content
from service.api.json_bodies import JSON, json_content, media_type, read_json_text, unsupported
from service.api.problems import documented
from service.api.uploads import MULTIPART, PICTURE_TYPES, file_part, read_fit_form
from service.estimates.questions import BodyTask
from service.jobs.addresses import target_fault
from service.jobs.inputs import SentPicture
from service.representation.jobs import FITS, represent
from service.submissions.refusal import of_view, parsed, refused
from service.submissions.submission import CheckedSubmission, check_detector, check_submission

ROUTER: Final = APIRouter(prefix=FITS, tags=["fits"])

_MASK: Final = "A grey picture of its picture's size; the person is brighter than half."
_BODY: Final[dict[str, Any]] = {
    "required": True,
    "content": {
        MULTIPART: {
            "schema": {
                "type": "object",
                "additionalProperties": False,
                "required": ["request", "image"],
                "properties": {
                    "request": json_content(FitRequest)["schema"],
                    "image": {
                        "type": "array",
                        "minItems": 1,
                        "maxItems": MOST_VIEWS,
                        "items": file_part("A picture: JPEG, PNG, WebP or HEIC."),
                    },
                    "mask": {
                        "type": "array",
                        "maxItems": MOST_VIEWS,
                        "items": file_part(f"{_MASK} One for each picture; replaces segmentation."),
                    },
                },
            },
            "encoding": {
                "request": {"contentType": JSON},
                "image": {"contentType": PICTURE_TYPES},
                "mask": {"contentType": PICTURE_TYPES},
            },
        },
        JSON: json_content(FitRequest),
    },
}


@ROUTER.post(
    "",
    status_code=202,
    response_model=Fit,
    summary="Submit pictures",
    openapi_extra={"requestBody": _BODY},
    responses=accepted()
    | documented(
        "malformed-request",
        "payload-too-large",
        "unsupported-media-type",
        "unusable-input",
        *ACCEPTANCE_PROBLEMS,
    ),
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
    the body is the same JSON with an `image_id` in every view. One body is found in all of them
    together. While it waits, a fit counts for as many as it has pictures.

    The same `Idempotency-Key` with the same content answers with the earlier fit. With `Prefer:
    wait=N` (at most 60 s) the answer waits for the fit's end.
    """
    text, asked, sent = await _read(request, context)
    checked = await run_in_threadpool(_checked, context, asked, sent)
    inputs = Inputs(
        options=checked.request.model_dump_json().encode(),
        files={
            name: File(content=file.content, media_type=file.media_type)
            for name, file in checked.files.items()
        },
        pictures=len(sent),
        label=asked.label,
        webhook=asked.webhook,
    )
    contents = (content for each in sent for content in (each.image, each.mask or b""))
    fit = await accept(
        context,
        inputs,
        key=idempotency(idempotency_key, text, *contents),
        check=partial(_refuse_nobody, context, asked),
    )
    return represent(await answer(context, response, fit, prefer=prefer))


async def _read(
    request: Request, context: ApiContext
) -> tuple[bytes, FitRequest, tuple[SentPicture[bytes], ...]]:
    """Read the request, as JSON text and as its type, and the pictures it speaks of."""
    if media_type(request) == JSON:
        text = await read_json_text(request)
        asked = parsed(FitRequest, text, whole="body", called="the body")
        return text, asked, await run_in_threadpool(_uploaded, context, asked)
    if media_type(request) != MULTIPART:
        raise unsupported(
            request,
            remedy=f"Send {MULTIPART} with the parts 'request' and 'image', or {JSON} with the "
            "image_id of an uploaded picture in every view.",
            accepted=f"{MULTIPART}, {JSON}",
        )
    text, images, masks = await read_fit_form(request, most=MOST_VIEWS)
    asked = parsed(FitRequest, text, whole="request", called="the part 'request'")
    return text, asked, _sent_along(asked, images, masks)


def _sent_along(
    asked: FitRequest, images: Sequence[bytes], masks: Sequence[bytes]
) -> tuple[SentPicture[bytes], ...]:
    for number, view in enumerate(asked.views):
        if view.image_id is not None or view.mask_id is not None:
            raise refused(
                FieldProblem(
                    field=f"views.{number}.{'mask_id' if view.image_id is None else 'image_id'}",
                    code="one-picture-needed",
                    reason="The pictures come with the request.",
                    remedy="Leave it out, or send the request alone, as JSON.",
                )
            )
    if not masks:
        return tuple(SentPicture(image, None) for image in images)
    if len(masks) != len(images):
        raise refused(
            FieldProblem(
                field="mask",
                code="views-count",
                reason=f"{len(images)} pictures came, and {len(masks)} masks.",
                remedy="Send no mask, or one for each picture, in their order.",
            )
        )
    return tuple(SentPicture(image, mask) for image, mask in zip(images, masks, strict=True))


def _uploaded(context: ApiContext, asked: FitRequest) -> tuple[SentPicture[bytes], ...]:
    pictures = []
    for number, view in enumerate(asked.views):
        with of_view(number):
            if view.image_id is None:
                raise refused(
                    FieldProblem(
                        field="image_id",
                        code="missing",
                        reason="The picture is missing.",
                        remedy=f"Send the id of an uploaded picture, or {MULTIPART} with the "
                        "parts 'request' and 'image'.",
                    )
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


async def _refuse_nobody(context: ApiContext, asked: FitRequest) -> None:
    """Refuse early what the fit would be refused for: measurements that no body combines."""
    if not asked.measurements and asked.weight_kg is None:
        return
    known = BodyRequest(
        gender=asked.gender,
        height_m=asked.height_m,
        weight_kg=asked.weight_kg,
        measurements=asked.measurements,
    )
    await context.estimates.refuse_nobody(BodyTask(request=known, with_glb=False))
