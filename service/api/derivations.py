"""What is derived from a finished fit, as jobs below it: they are erased and expire with it.

Their paths lie below the fit's, because a derivation has no life of its own: who may see the fit
may see it, and where the fit is gone there is nothing.
"""

import codecs
from collections.abc import Collection
from dataclasses import dataclass
from typing import Any, Final
from uuid import UUID

from fastapi import APIRouter, Request, Response
from fastapi.responses import StreamingResponse
from starlette.concurrency import run_in_threadpool

from api_schemas.derivations import (
    AnimationOptions,
    AnyDerivationOptions,
    CombinedOptions,
    Derivation,
    DerivationKind,
    DerivationPage,
    DerivationRequest,
    DerivationResult,
)
from api_schemas.jobs import JobState
from api_schemas.problems import FieldProblem, problem
from service.api.acceptance import (
    ACCEPTANCE_PROBLEMS,
    File,
    IdempotencyKey,
    Inputs,
    Prefer,
    accept,
    accepted,
    answer,
    idempotency,
)
from service.api.context import ApiContext, Context
from service.api.events import STREAM, LastEventId, event_stream
from service.api.fit_inputs import serve_blob
from service.api.job_routes import (
    JOB_PROBLEMS,
    NOT_MODIFIED,
    Cursor,
    IfNoneMatch,
    Limit,
    State,
    cancel_job,
    erase_job,
    find,
    not_modified,
    page_of,
)
from service.api.json_bodies import (
    JSON,
    json_content,
    media_type,
    read_json_text,
    unsupported,
)
from service.api.problems import ProblemError, documented, not_found
from service.api.representation import derivations_path, represent_derivation
from service.api.results import (
    RangeHeader,
    file_answers,
    no_result,
    serve_file,
    serve_result,
)
from service.api.uploads import MULTIPART, read_request_and_file
from service.blobs import BlobMissingError
from service.engine.port import JobRecord, StoredBlob
from service.inputs import CLIP, OF_ITS_FIT, PERSON, other_person
from service.refusal import refused
from service.validation import parsed
from service.webhooks.targets import check_webhook

MAX_CLIP_BYTES: Final = 32 * 1024 * 1024
"""What the fitter reads at most; a minute of motion capture is a tenth of it."""

ROUTER: Final = APIRouter(prefix="/v1/fits/{fit_id}/derivations", tags=["derivations"])


_SUBMISSION: Final[dict[str, Any]] = {
    "requestBody": {
        "required": True,
        "content": {
            JSON: json_content(DerivationRequest),
            MULTIPART: {
                "schema": {
                    "type": "object",
                    "additionalProperties": False,
                    "required": ["request", CLIP],
                    "properties": {
                        "request": {"$ref": "#/components/schemas/AnimationOptions"},
                        CLIP: {
                            "type": "string",
                            "format": "binary",
                            "description": (
                                "A motion as a BVH file, of a skeleton with the joint names of "
                                "CMU, Mixamo, Rokoko or Blender."
                            ),
                        },
                    },
                },
                "encoding": {
                    "request": {"contentType": JSON},
                    CLIP: {"contentType": "text/plain, application/octet-stream"},
                },
            },
        },
    }
}


@ROUTER.post(
    "",
    status_code=202,
    response_model=Derivation,
    summary="Derive something from a fit",
    openapi_extra=_SUBMISSION,
    responses=accepted(Derivation)
    | documented(
        "malformed-request",
        "not-found",
        "no-result",
        "fit-expired",
        "payload-too-large",
        "unsupported-media-type",
        *ACCEPTANCE_PROBLEMS,
    ),
)
async def derive(
    fit_id: UUID,
    request: Request,
    response: Response,
    context: Context,
    idempotency_key: IdempotencyKey = None,
    prefer: Prefer = None,
) -> Derivation:
    """Accept a job that makes something of a fit that has succeeded; `kind` says what.

    It has copies of its own of what it needs of the fit; erasing the fit erases it too. A motion
    comes along as the part `bvh` of a form, whose part `request` is the JSON; without one an
    animated body walks.

    `Idempotency-Key` and `Prefer` are as for fits.
    """
    asked, sent = await _asked(request)
    check_webhook(asked.webhook, context.settings)
    inputs = await run_in_threadpool(_inputs, context, fit_id, asked, sent.clip)
    jobs = context.jobs.derivations(str(fit_id))
    key = idempotency(
        idempotency_key, b"derivation", str(fit_id).encode(), sent.text, sent.clip or b""
    )
    job = await accept(context, jobs, inputs, key=key)
    return represent_derivation(await answer(context, jobs, response, job, prefer=prefer))


@ROUTER.get(
    "",
    response_model=DerivationPage,
    summary="List what was derived from a fit, newest first",
    responses=documented(*JOB_PROBLEMS),
)
def list_derivations(
    fit_id: UUID,
    response: Response,
    context: Context,
    limit: Limit = 50,
    cursor: Cursor = None,
    state: State = None,
) -> DerivationPage:
    """List the jobs; `next` and the Link header lead to the following page."""
    fit = find(context.jobs, fit_id)
    page, following = page_of(
        context.jobs.derivations(fit.id),
        response,
        path=derivations_path(fit.id),
        limit=limit,
        cursor=cursor,
        state=state,
    )
    return DerivationPage(
        derivations=tuple(represent_derivation(record) for record in page), next=following
    )


@ROUTER.get(
    "/{derivation_id}",
    response_model=Derivation,
    summary="Look at a derivation",
    responses=NOT_MODIFIED | documented(*JOB_PROBLEMS),
)
def get_derivation(
    fit_id: UUID,
    derivation_id: UUID,
    response: Response,
    context: Context,
    if_none_match: IfNoneMatch = None,
) -> Any:
    """Return where the job stands."""
    record = _find(context, fit_id, derivation_id)
    return not_modified(record, response, if_none_match) or represent_derivation(record)


@ROUTER.post(
    "/{derivation_id}/cancel",
    status_code=202,
    response_model=Derivation,
    summary="Cancel a derivation",
    responses={
        200: {"model": Derivation, "description": "The job has ended."},
        202: {"description": "The job is being stopped."},
    }
    | documented(*JOB_PROBLEMS),
)
def cancel_derivation(
    fit_id: UUID, derivation_id: UUID, response: Response, context: Context
) -> Derivation:
    """Stop a job; canceling again, or canceling what has ended, changes nothing."""
    jobs = context.jobs.derivations(str(fit_id))
    return represent_derivation(cancel_job(jobs, derivation_id, response))


@ROUTER.delete(
    "/{derivation_id}",
    status_code=204,
    summary="Erase a derivation",
    responses=documented(*JOB_PROBLEMS),
)
def erase_derivation(fit_id: UUID, derivation_id: UUID, context: Context) -> Response:
    """Stop the job if it runs, and erase it with its copies and results; the fit stays."""
    return erase_job(context, context.jobs.derivations(str(fit_id)), derivation_id)


@ROUTER.get(
    "/{derivation_id}/events",
    summary="Follow a derivation",
    response_class=StreamingResponse,
    responses={200: STREAM} | documented(*JOB_PROBLEMS),
)
def follow_derivation(
    fit_id: UUID, derivation_id: UUID, context: Context, last_event_id: LastEventId = None
) -> StreamingResponse:
    """Stream state changes, stages and progress, as for fits."""
    jobs = context.jobs.derivations(str(fit_id))
    return event_stream(context, jobs, derivation_id, last_event_id)


@ROUTER.get(
    "/{derivation_id}/request",
    summary="The request of a derivation",
    response_class=Response,
    responses={
        200: {
            "description": "As it was understood, defaults included.",
            "content": {JSON: json_content(DerivationRequest)},
        },
    }
    | NOT_MODIFIED
    | documented(*JOB_PROBLEMS),
)
def derivation_request(
    fit_id: UUID, derivation_id: UUID, context: Context, if_none_match: IfNoneMatch = None
) -> Response:
    """Return what was asked for: to be changed and sent again."""
    record = _find(context, fit_id, derivation_id)
    return serve_blob(context, record, record.options, if_none_match)


@ROUTER.get(
    "/{derivation_id}/result",
    summary="The result document of a derivation",
    responses={200: {"model": DerivationResult}}
    | NOT_MODIFIED
    | documented("no-result", *JOB_PROBLEMS),
)
def derivation_result(
    fit_id: UUID, derivation_id: UUID, context: Context, if_none_match: IfNoneMatch = None
) -> Response:
    """Return what there is to say of it, and the files' names."""
    record = _find(context, fit_id, derivation_id)
    return serve_result(context, record, if_none_match=if_none_match)


@ROUTER.get(
    "/{derivation_id}/artifacts/{name}",
    summary="A file of a derivation",
    response_class=Response,
    responses=file_answers(
        "text/html", "application/pdf", "model/gltf-binary", "image/png", "image/webp"
    ),
)
def derivation_artifact(
    fit_id: UUID,
    derivation_id: UUID,
    name: str,
    context: Context,
    if_none_match: IfNoneMatch = None,
    range_header: RangeHeader = None,
) -> Response:
    """Return a file: `report.pdf` and so on, as the job's links name them."""
    record = _find(context, fit_id, derivation_id)
    return serve_file(context, record, name, range_header=range_header, if_none_match=if_none_match)


def _find(context: ApiContext, fit_id: UUID, derivation_id: UUID) -> JobRecord:
    return find(context.jobs.derivations(str(fit_id)), derivation_id)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Sent:
    """The request as JSON text, and the motion that came along."""

    text: bytes
    clip: bytes | None


async def _asked(request: Request) -> tuple[AnyDerivationOptions, _Sent]:
    if media_type(request) == JSON:
        text = await read_json_text(request)
        asked = parsed(DerivationRequest, text, whole="body", called="the body")
        return asked.root, _Sent(text=text, clip=None)
    if media_type(request) != MULTIPART:
        raise unsupported(
            request,
            remedy=f"Send {JSON}, or {MULTIPART} with the parts 'request' and '{CLIP}'.",
            accepted=f"{JSON}, {MULTIPART}",
        )
    text, clip = await read_request_and_file(request, CLIP)
    asked = parsed(DerivationRequest, text, whole="request", called="the part 'request'")
    if not isinstance(asked.root, AnimationOptions):
        raise refused(
            FieldProblem(
                field=CLIP,
                code="unknown-field",
                reason=f"A {asked.root.kind} takes no motion.",
                remedy="Send the request alone, as JSON, or ask for an animation.",
            )
        )
    _check_clip(clip)
    return asked.root, _Sent(text=text, clip=clip)


def _check_clip(clip: bytes) -> None:
    """Check what can be told of a BVH file without reading it."""
    if len(clip) > MAX_CLIP_BYTES:
        raise ProblemError(
            problem(
                "payload-too-large",
                field=CLIP,
                detail=f"The motion has {len(clip)} bytes, more than {MAX_CLIP_BYTES}.",
                remedy="Cut the clip, or lower its frame rate.",
            )
        )
    if not clip.removeprefix(codecs.BOM_UTF8).lstrip()[:9].upper() == b"HIERARCHY":
        raise refused(
            FieldProblem(
                field=CLIP,
                code="not-a-bvh",
                reason="The motion does not begin with HIERARCHY: it is no BVH file.",
                remedy="Export the motion as BVH.",
            )
        )


def _inputs(
    context: ApiContext, fit_id: UUID, options: AnyDerivationOptions, clip: bytes | None
) -> Inputs:
    fit = find(context.jobs, fit_id)
    if fit.state is not JobState.SUCCEEDED:
        raise ProblemError(no_result(fit))
    files = _files_of(context, fit, OF_ITS_FIT[DerivationKind(options.kind)])
    if isinstance(options, CombinedOptions):
        for index, other in enumerate(options.fits):
            person = _person_of_another(context, index, other, than=fit_id)
            files[other_person(index)] = person
    if clip is not None:
        files[CLIP] = File(content=clip, media_type="text/plain")
    return Inputs(
        kind=options.kind,
        options=options.model_dump_json(exclude={"webhook"}).encode(),
        files=files,
        webhook=options.webhook,
    )


def _files_of(context: ApiContext, fit: JobRecord, needed: Collection[str]) -> dict[str, File]:
    """Copies of a fit's inputs and files, so far as it has them."""
    kept = dict(fit.inputs) | {
        artifact.name: StoredBlob(digest=artifact.sha256, media_type=artifact.media_type)
        for artifact in fit.artifacts
    }
    try:
        return {
            name: File(content=context.blobs.get(fit.id, blob.digest), media_type=blob.media_type)
            for name, blob in kept.items()
            if name in needed
        }
    except BlobMissingError as error:
        raise not_found(what="such fit any more") from error


def _person_of_another(context: ApiContext, index: int, other: UUID, *, than: UUID) -> File:
    """The person of a fit that a request names beside its own."""
    record = None if other == than else context.jobs.job(str(other))
    person = None
    if record is not None and record.state is JobState.SUCCEEDED:
        person = _files_of(context, record, (PERSON,)).get(PERSON)
    if person is None:
        reason = "is the one it is derived from" if other == than else "has not succeeded here"
        raise refused(
            FieldProblem(
                field=f"fits.{index}",
                code="fits-unusable",
                reason=f"The fit {other} {reason}.",
                remedy="Name other fits of yours that have succeeded.",
            )
        )
    return person
