"""The inputs of a job: its picture and its request, for later reference."""

from typing import Final
from uuid import UUID

from fastapi import APIRouter, Response

from service.api.context import ApiContext, Context
from service.api.job_routes import JOB_PROBLEMS, NOT_MODIFIED, IfNoneMatch, find
from service.api.json_bodies import JSON
from service.api.problems import documented, not_found
from service.blobs import BlobMissingError
from service.engine.port import JobRecord, StoredBlob
from service.jobs.inputs import IMAGE, MASK

ROUTER: Final = APIRouter(prefix="/v1/fits", tags=["fits"])

_BINARY: Final = {"schema": {"type": "string", "format": "binary"}}
UNDERSTOOD: Final = "As it was understood, defaults included."
AS_SENT: Final = {
    200: {
        "description": "The file as it was sent.",
        "content": {"image/jpeg": _BINARY, "image/png": _BINARY, "image/webp": _BINARY},
    },
}


@ROUTER.get(
    "/{fit_id}/image",
    summary="The picture of a job",
    response_class=Response,
    responses=AS_SENT | NOT_MODIFIED | documented(*JOB_PROBLEMS),
)
def fit_image(fit_id: UUID, context: Context, if_none_match: IfNoneMatch = None) -> Response:
    """Return the picture as it was sent; it is erased with the job."""
    record = find(context.jobs, fit_id)
    return serve_blob(context, record, record.inputs[IMAGE], if_none_match)


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
    headers = {
        "ETag": f'"{blob.digest}"',
        "Cache-Control": "private, immutable, max-age=31536000",
    }
    if if_none_match is not None and (blob.digest in if_none_match or if_none_match == "*"):
        return Response(status_code=304, headers=headers)
    try:
        content = context.blobs.get(record.id, blob.digest)
    except BlobMissingError as error:
        raise not_found(what="such job any more") from error
    return Response(content, media_type=blob.media_type, headers=headers)
