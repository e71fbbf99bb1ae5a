"""Pictures uploaded once, for any number of initial poses and fits."""

import contextlib
import hashlib
from datetime import UTC, datetime
from typing import Annotated, Any, Final
from uuid import uuid4

from fastapi import APIRouter, Path, Request, Response
from starlette.concurrency import run_in_threadpool

from api_schemas.picture import ImageId, ImagePage, UploadedImage
from service.api.context import ApiContext, Context
from service.api.files import (
    BINARY,
    NOT_MODIFIED,
    OCTETS,
    PICTURES,
    Wanted,
    answer_file,
    picture_rendition,
)
from service.api.listing import Cursor, Limit, page_of, read_cursor
from service.api.problems import ProblemError, documented, not_found, problem_error
from service.api.requests import Part, body, form_content, read_form
from service.api.storage import (
    disk_full,
    erase_at_once,
    erase_blobs,
    storing,
    with_blobs,
    writing,
)
from service.jobs.blobs import BlobMissingError, BlobsUnavailableError
from service.jobs.images import ImageQuotaError, ImageRecord, NewImage
from service.jobs.inputs import IMAGE
from service.jobs.records import StoredBlob
from service.submissions.refusal import refused_field
from service.submissions.submission import check_picture

PATH: Final = "/v1/images"
ROUTER: Final = APIRouter(prefix=PATH, tags=["images"])

_PARTS: Final = {IMAGE: Part(description="JPEG, PNG, WebP or HEIC.", least=1)}
_PICTURE: Final[dict[int | str, dict[str, Any]]] = {
    200: {"description": "The file.", "content": dict.fromkeys((OCTETS, *PICTURES), BINARY)}
}
_LOCATION: Final = {
    "Location": {"description": "Path of the picture.", "schema": {"type": "string"}}
}


@ROUTER.post(
    "",
    status_code=201,
    response_model=UploadedImage,
    summary="Upload a picture",
    openapi_extra=body(form=form_content(_PARTS)),
    responses={
        200: {
            "description": "The same picture is there already; its time begins anew.",
            "model": UploadedImage,
            "headers": _LOCATION,
        },
        201: {"description": "Kept.", "model": UploadedImage, "headers": _LOCATION},
    }
    | documented("insufficient-storage"),
)
async def upload_image(request: Request, response: Response, context: Context) -> UploadedImage:
    """Keep a picture, to be named by its id in fits and initial poses.

    The id is the SHA-256 of the file. It is erased at its `expires_at`, or by DELETE; fits that
    were made of it have a copy of their own.
    """
    (content,) = (await read_form(request, _PARTS))[IMAGE]
    with storing():
        kept, is_new = await with_blobs(context.blobs, _keep, context, content)
    response.status_code = 201 if is_new else 200
    response.headers["Location"] = f"{PATH}/{kept.id}"
    return _represent(kept)


@ROUTER.get(
    "",
    response_model=ImagePage,
    summary="List uploaded pictures, newest first",
)
def list_images(
    response: Response, context: Context, limit: Limit = 50, cursor: Cursor = None
) -> ImagePage:
    """List the tenant's pictures. `next` and the Link header lead to the following page."""
    found = context.images.images(limit=limit + 1, before=read_cursor(cursor))
    page, following = page_of(found, response, path=PATH, limit=limit)
    return ImagePage(images=tuple(map(_represent, page)), next=following)


@ROUTER.get(
    "/{image_id}",
    response_model=UploadedImage,
    summary="Look at an uploaded picture's facts",
    responses=documented("not-found"),
)
def get_image(
    image_id: Annotated[ImageId, Path()], response: Response, context: Context
) -> UploadedImage:
    """Return kind, size and focal length of a picture, and when it expires."""
    record = context.images.find(image_id)
    if record is None:
        raise not_found(what="such picture")
    return _represent(record)


@ROUTER.get(
    "/{image_id}/picture",
    summary="An uploaded picture itself",
    response_class=Response,
    responses=_PICTURE | NOT_MODIFIED | documented("not-found"),
)
async def get_picture(
    image_id: Annotated[ImageId, Path()], context: Context, wanted: Wanted
) -> Response:
    """Return the picture as it was sent.

    Where `Accept` names `image/jpeg` and not its kind, it comes as a JPEG, upright and of the same
    size: most browsers cannot show HEIC.
    """
    record = await run_in_threadpool(context.images.find, image_id)
    if record is None:
        raise not_found(what="such picture")
    picture = StoredBlob(digest=record.id, media_type=record.media_type)
    rendition = picture_rendition(picture, accept=wanted.accept)
    return await answer_file(context, record.scope, rendition, wanted)


@ROUTER.delete(
    "/{image_id}",
    status_code=204,
    summary="Erase an uploaded picture",
    responses=documented("not-found"),
)
async def erase_image(image_id: Annotated[ImageId, Path()], context: Context) -> Response:
    """Erase a picture; fits that were made of it are not affected."""
    scopes = await writing(context.images.erase, image_id)
    if not scopes:
        raise not_found(what="such picture")
    await erase_blobs(context.blobs, scopes)
    return Response(status_code=204)


def image_content(context: ApiContext, image_id: str, *, field: str) -> bytes:
    """Return the file of the picture that a request names in a field.

    Raises
    ------
    RefusedError
        If there is no such picture, or no longer.
    """
    record = context.images.find(image_id)
    if record is not None:
        with contextlib.suppress(BlobMissingError):
            return context.blobs.get(record.scope, record.id)
    raise refused_field(
        field=field,
        code="unknown-image",
        reason="There is no uploaded picture with this id; it may have expired.",
        remedy="Upload the picture to /v1/images and send the id it answers.",
    )


def _keep(context: ApiContext, content: bytes) -> tuple[ImageRecord, bool]:
    """Keep a picture; returns its record, and whether it is new."""
    header = check_picture(
        "image", content, max_pixels=context.settings.max_pixels, read=context.read_header
    )
    image_id = hashlib.sha256(content).hexdigest()
    earlier = context.images.renew(image_id)
    if earlier is not None:
        return earlier, False
    if not context.disk.has_room_for(len(content)):
        raise disk_full()
    scope = str(uuid4())
    # From here on the scope is erased automatically unless the picture is kept.
    try:
        context.images.reserve(scope, size=len(content))
    except ImageQuotaError as error:
        raise _no_quota(error) from error
    try:
        context.blobs.put(scope, content)
    except BlobsUnavailableError:
        erase_at_once(context.blobs, scope)
        raise
    new = NewImage(
        id=image_id,
        scope=scope,
        media_type=header.media_type,
        width=header.width,
        height=header.height,
        size=len(content),
        focal_length_35mm=header.focal_length_35mm,
    )
    kept = context.images.keep(new)
    if kept is None or kept.scope != scope:
        erase_at_once(context.blobs, scope)
    if kept is None:
        raise problem_error(
            slug="not-ready",
            code="submission-lost",
            detail="The upload took too long and was given up.",
            remedy="Post the picture again.",
        )
    return kept, kept.scope == scope


def _no_quota(error: ImageQuotaError) -> ProblemError:
    return problem_error(
        slug="quota-exceeded",
        detail=str(error),
        remedy="Erase pictures you need no more by DELETE /v1/images/{id}, or wait until they "
        "expire; a fit can also bring its picture along.",
    )


def _represent(record: ImageRecord) -> UploadedImage:
    return UploadedImage(
        id=record.id,
        media_type=record.media_type,
        width=record.width,
        height=record.height,
        size=record.size,
        focal_length_35mm=record.focal_length_35mm,
        created_at=datetime.fromtimestamp(record.created_at, UTC),
        expires_at=datetime.fromtimestamp(record.expires_at, UTC),
    )
