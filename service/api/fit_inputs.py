"""What a job was made of: its picture and its request, for whoever looks at it again later."""

from typing import Annotated, Final
from uuid import UUID

from fastapi import APIRouter, Header, Response

from service.api.context import ApiContext, Context
from service.api.fits import find
from service.api.json_bodies import JSON
from service.api.problems import documented, not_found
from service.blobs import BlobMissingError
from service.engine.port import JobRecord, StoredBlob

ROUTER: Final = APIRouter(prefix="/v1/fits", tags=["fits"])

_PROBLEMS: Final = documented(
    "not-found", "fit-expired", "invalid-request", "not-ready", "internal-error"
)
_BINARY: Final = {"schema": {"type": "string", "format": "binary"}}


@ROUTER.get(
    "/{fit_id}/image",
    summary="The picture of a job",
    response_class=Response,
    responses={
        200: {
            "description": "The file as it was sent.",
            "content": {"image/jpeg": _BINARY, "image/png": _BINARY, "image/webp": _BINARY},
        },
        304: {"description": "Not changed since the given ETag."},
    }
    | _PROBLEMS,
)
def fit_image(
    fit_id: UUID, context: Context, if_none_match: Annotated[str | None, Header()] = None
) -> Response:
    """Return the picture as it was sent; it is erased with the job."""
    record = find(context, fit_id)
    return _serve(context, record, record.image, if_none_match)


@ROUTER.get(
    "/{fit_id}/request",
    summary="The request of a job",
    response_class=Response,
    responses={
        200: {
            "description": "As it was understood, defaults included.",
            "content": {JSON: {"schema": {"$ref": "#/components/schemas/FitOptions"}}},
        },
        304: {"description": "Not changed since the given ETag."},
    }
    | _PROBLEMS,
)
def fit_request(
    fit_id: UUID, context: Context, if_none_match: Annotated[str | None, Header()] = None
) -> Response:
    """Return what was asked for, points by name: to be changed and sent again."""
    record = find(context, fit_id)
    return _serve(context, record, record.options, if_none_match)


def _serve(
    context: ApiContext, record: JobRecord, blob: StoredBlob, if_none_match: str | None
) -> Response:
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
