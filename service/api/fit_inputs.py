"""The inputs of a job: its picture and its request, for later reference."""

from collections.abc import Callable
from functools import partial
from typing import Final
from uuid import UUID

from fastapi import APIRouter, Response
from starlette.concurrency import run_in_threadpool

from service.api.artifacts import BINARY, AcceptHeader
from service.api.context import ApiContext, Context
from service.api.job_routes import JOB_PROBLEMS, NOT_MODIFIED, IfNoneMatch, find
from service.api.json_bodies import JSON
from service.api.negotiation import preferred
from service.api.problems import documented, not_found
from service.blobs import BlobMissingError
from service.engine.port import JobRecord, StoredBlob
from service.jobs.inputs import IMAGE, MASK

ROUTER: Final = APIRouter(prefix="/v1/fits", tags=["fits"])

JPEG: Final = "image/jpeg"
UNDERSTOOD: Final = "As it was understood, defaults included."
AS_SENT: Final = {
    200: {
        "description": "The file as it was sent.",
        "content": dict.fromkeys((JPEG, "image/png", "image/webp", "image/heic"), BINARY),
    },
}
# What cannot be decoded cannot be had as a JPEG.
PICTURE_ANSWERS: Final = AS_SENT | NOT_MODIFIED | documented(*JOB_PROBLEMS, "unusable-input")
AS_JPEG: Final = """

With `Accept: image/jpeg` a picture of another kind comes as a JPEG, upright and of the same size:
most browsers cannot show HEIC. With any other `Accept` it comes as it was sent."""


@ROUTER.get(
    "/{fit_id}/image",
    summary="The picture of a job",
    description=f"Return the picture as it was sent; it is erased with the job.{AS_JPEG}",
    response_class=Response,
    responses=PICTURE_ANSWERS,
)
async def fit_image(
    fit_id: UUID,
    context: Context,
    if_none_match: IfNoneMatch = None,
    accept: AcceptHeader = None,
) -> Response:
    """Return the picture as it was sent, or as a JPEG."""
    record = await run_in_threadpool(find, context.jobs, fit_id)
    return await serve_picture(context, record, record.inputs[IMAGE], if_none_match, accept)


@ROUTER.get(
    "/{fit_id}/mask",
    summary="The mask of a job",
    response_class=Response,
    responses=AS_SENT | NOT_MODIFIED | documented(*JOB_PROBLEMS),
)
def fit_mask(fit_id: UUID, context: Context, if_none_match: IfNoneMatch = None) -> Response:
    """Return the mask as it was sent; `not-found` if none was."""
    record = find(context.jobs, fit_id)
    if MASK not in record.inputs:
        raise not_found(what="mask: this job was sent none")
    return serve_blob(context, record, record.inputs[MASK], if_none_match)


@ROUTER.get(
    "/{fit_id}/request",
    summary="The request of a job",
    response_class=Response,
    responses={
        200: {
            "description": UNDERSTOOD,
            "content": {JSON: {"schema": {"$ref": "#/components/schemas/FitOptions"}}},
        },
    }
    | NOT_MODIFIED
    | documented(*JOB_PROBLEMS),
)
def fit_request(fit_id: UUID, context: Context, if_none_match: IfNoneMatch = None) -> Response:
    """Return what was asked for, points by name: to be changed and sent again."""
    record = find(context.jobs, fit_id)
    return serve_blob(context, record, record.options, if_none_match)


def serve_blob(
    context: ApiContext, record: JobRecord, blob: StoredBlob, if_none_match: str | None
) -> Response:
    """Answer with an input of a job."""
    headers = _headers(blob.digest)
    if _is_known(blob.digest, if_none_match):
        return Response(status_code=304, headers=headers)
    content = _content(context, record, blob)
    return Response(content, media_type=blob.media_type, headers=headers)


async def serve_picture(
    context: ApiContext,
    record: JobRecord,
    blob: StoredBlob,
    if_none_match: str | None,
    accept: str | None,
) -> Response:
    """Answer with a picture of a job as it was sent, or as a JPEG where that is preferred."""
    read = partial(_content, context, record, blob)
    return await serve_stored_picture(context, blob, read, if_none_match, accept)


async def serve_stored_picture(
    context: ApiContext,
    blob: StoredBlob,
    read: Callable[[], bytes],
    if_none_match: str | None,
    accept: str | None,
) -> Response:
    """Answer with a picture that ``read`` reads, or with it as a JPEG where that is preferred."""
    kind = blob.media_type
    is_converted = kind != JPEG and preferred(accept, [kind, JPEG]) == JPEG
    tag = f"{blob.digest}-jpeg" if is_converted else blob.digest
    headers = _headers(tag) | {"Vary": "Accept"}
    if _is_known(tag, if_none_match):
        return Response(status_code=304, headers=headers)
    content = await run_in_threadpool(read)
    if is_converted:
        return Response(await context.estimates.jpeg(content), media_type=JPEG, headers=headers)
    return Response(content, media_type=kind, headers=headers)


def _headers(tag: str) -> dict[str, str]:
    return {"ETag": f'"{tag}"'}


def _is_known(tag: str, if_none_match: str | None) -> bool:
    return if_none_match is not None and (f'"{tag}"' in if_none_match or if_none_match == "*")


def _content(context: ApiContext, record: JobRecord, blob: StoredBlob) -> bytes:
    try:
        return context.blobs.get(record.id, blob.digest)
    except BlobMissingError as error:
        raise not_found(what="such job any more") from error
