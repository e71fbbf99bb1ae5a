"""Submit the pictures of a person, one for a fit or several for a scan: checks, then a job."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Final

from fastapi import APIRouter, Request, Response
from starlette.concurrency import run_in_threadpool

from api_schemas.bodies import BodyRequest
from api_schemas.jobs import JobStanding
from api_schemas.requests import FitOfImage, FitRequest, Person
from api_schemas.scans import LEAST_VIEWS, MOST_VIEWS, ScanOfImages, ScanRequest
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
from service.api.job_resources import FITS, SCANS, JobResource
from service.api.json_bodies import JSON, json_content, media_type, read_json_text, unsupported
from service.api.problems import documented
from service.api.uploads import MULTIPART, check_names, read_request_and_some
from service.engine.port import SCAN
from service.estimates.questions import BodyTask
from service.jobs.inputs import PictureNames, SentPicture, picture_names
from service.representation.jobs import represent
from service.submissions.detector import check_detector
from service.submissions.refusal import of_picture
from service.submissions.submission import CheckedSubmission, check_submission
from service.submissions.validation import parsed
from service.webhooks.targets import check_webhook

Asked = FitRequest | ScanRequest

PICTURES: Final = "image/jpeg, image/png, image/webp, image/heic"
REQUEST_PART: Final = "request"


@dataclass(frozen=True, slots=True, kw_only=True)
class Submissions:
    """How a fit or a scan is asked for.

    ``request`` is the type of a form's part of that name, ``of_images`` that of a body that names
    uploaded pictures. A form has parts for ``least`` to ``most`` pictures.
    """

    of: JobResource
    request: type[FitRequest] | type[ScanRequest]
    of_images: type[FitOfImage] | type[ScanOfImages]
    least: int
    most: int
    summary: str
    description: str

    @property
    def parts(self) -> tuple[PictureNames, ...]:
        """Names of all the parts that a form may have beside the request."""
        return picture_names(self.most)

    @property
    def body(self) -> dict[str, Any]:
        """Describe form and JSON for the OpenAPI document."""
        files: dict[str, Any] = {}
        for number, part in enumerate(self.parts):
            files |= _files(part, number, among=self.most)
        return {
            "required": True,
            "content": {
                MULTIPART: {
                    "schema": {
                        "type": "object",
                        "additionalProperties": False,
                        "required": [REQUEST_PART, *_images(self.parts[: self.least])],
                        "properties": {REQUEST_PART: json_content(self.request)["schema"]} | files,
                    },
                    "encoding": {REQUEST_PART: {"contentType": JSON}}
                    | {name: {"contentType": PICTURES} for name in files},
                },
                JSON: json_content(self.of_images),
            },
        }


FIT_SUBMISSIONS: Final = Submissions(
    of=FITS,
    request=FitRequest,
    of_images=FitOfImage,
    least=1,
    most=1,
    summary="Submit a picture",
    description="""Accept a picture with its points; the answer is a job to follow.

The picture comes along, or was uploaded to `/v1/images` before: then the body is JSON and names it
by `image_id`.

The same `Idempotency-Key` with the same content answers with the earlier job. With `Prefer: wait=N`
(at most 60 s) the answer waits for the job's end.""",
)

SCAN_SUBMISSIONS: Final = Submissions(
    of=SCANS,
    request=ScanRequest,
    of_images=ScanOfImages,
    least=LEAST_VIEWS,
    most=MOST_VIEWS,
    summary="Submit pictures of one person",
    description="""Accept pictures of one person, from the front and the side, say; the answer is \
a job.

The pictures come along, `image_0` that of the first of the `views` and so on, or were uploaded to
`/v1/images` before: then the body is JSON, and every view names its own by `image_id`.

One body is found in all of them together. While it waits, a scan counts for as many jobs as it has
pictures. `Idempotency-Key` and `Prefer` are as for fits.""",
)


def _router(kind: Submissions) -> APIRouter:
    router = APIRouter(prefix=kind.of.path, tags=[kind.of.tag])

    @router.post(
        "",
        name=kind.of.operations["submit"],
        status_code=202,
        response_model=kind.of.model,
        summary=kind.summary,
        description=kind.description,
        openapi_extra={"requestBody": kind.body},
        responses=accepted(kind.of.model)
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
    ) -> JobStanding:
        text, asked, sent = await _read(kind, request, context)
        checked = await run_in_threadpool(_checked, context, asked, sent)
        jobs = context.jobs[kind.of.root]
        inputs = Inputs(
            kind=kind.of.root,
            options=checked.options.model_dump_json().encode(),
            files={
                name: File(content=file.content, media_type=file.media_type)
                for name, file in checked.files.items()
            },
            pictures=len(sent),
            label=checked.label,
            webhook=checked.webhook,
        )
        contents = (content for each in sent for content in (each.image, each.mask or b""))
        # Of the same parts a fit and a scan are two things; a fit has had no name from the first.
        said = (SCAN.encode(),) if kind.of is SCANS else ()
        job = await accept(
            context,
            jobs,
            inputs,
            key=idempotency(idempotency_key, *said, text, *contents),
            check=partial(_refuse_nobody, context, checked.options),
        )
        return represent(await answer(context, jobs, response, job, prefer=prefer))

    return router


async def _read(
    kind: Submissions, request: Request, context: ApiContext
) -> tuple[bytes, Asked, tuple[SentPicture[bytes], ...]]:
    """Read the request, as JSON text and as its type, and the pictures it speaks of."""
    if media_type(request) == JSON:
        text = await read_json_text(request)
        named = parsed(kind.of_images, text, whole="body", called="the body")
        return text, named, await run_in_threadpool(_uploaded, context, named)
    if media_type(request) != MULTIPART:
        needed = ", ".join(map(repr, _images(kind.parts[: kind.least])))
        raise unsupported(
            request,
            remedy=f"Send {MULTIPART} with the parts '{REQUEST_PART}' and {needed}, or {JSON} "
            "with the image_id of an uploaded picture for each.",
            accepted=f"{MULTIPART}, {JSON}",
        )
    text, parts = await read_request_and_some(request, _names(kind.parts))
    asked = parsed(kind.request, text, whole=REQUEST_PART, called=f"the part '{REQUEST_PART}'")
    return text, asked, _sent_along(asked, parts)


def _sent_along(asked: Asked, parts: Mapping[str, bytes]) -> tuple[SentPicture[bytes], ...]:
    names = picture_names(len(asked.pictures))
    check_names(parts, needed=_images(names), known=(REQUEST_PART, *_names(names)))
    return tuple(SentPicture(parts[each.image], parts.get(each.mask)) for each in names)


def _uploaded(
    context: ApiContext, asked: FitOfImage | ScanOfImages
) -> tuple[SentPicture[bytes], ...]:
    pictures = []
    for number, each in enumerate(asked.pictures):
        with of_picture(number, among=len(asked.pictures)):
            image = image_content(context, each.image_id, field="image_id")
            mask = None
            if each.mask_id is not None:
                mask = image_content(context, each.mask_id, field="mask_id")
        pictures.append(SentPicture(image, mask))
    return tuple(pictures)


def _checked(
    context: ApiContext, asked: Asked, sent: Sequence[SentPicture[bytes]]
) -> CheckedSubmission[Any]:
    checked = check_submission(asked, sent, max_pixels=context.settings.max_pixels)
    check_webhook(checked.webhook, context.settings)
    check_detector(checked.options, context.settings.detector_dir)
    return checked


async def _refuse_nobody(context: ApiContext, person: Person) -> None:
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


def _images(names: Sequence[PictureNames]) -> tuple[str, ...]:
    return tuple(each.image for each in names)


def _names(pictures: Sequence[PictureNames]) -> tuple[str, ...]:
    return tuple(name for each in pictures for name in each)


def _files(part: PictureNames, number: int, *, among: int) -> dict[str, Any]:
    of_which = "" if among == 1 else f" of view {number}"
    mask = f"A grey picture of the size of the picture{of_which}; the person is brighter than half."
    return {
        part.image: _file(f"The picture{of_which}: JPEG, PNG, WebP or HEIC."),
        part.mask: _file(f"{mask} Replaces the segmentation."),
    }


def _file(description: str) -> dict[str, str]:
    return {"type": "string", "format": "binary", "description": description}


ROUTER: Final = APIRouter()
for _each in (FIT_SUBMISSIONS, SCAN_SUBMISSIONS):
    ROUTER.include_router(_router(_each))
