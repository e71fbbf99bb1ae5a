"""The pictures that jobs were sent, and their masks."""

from collections.abc import Callable
from functools import partial
from typing import Annotated, Final
from uuid import UUID

from fastapi import APIRouter, Depends, Path, Response
from starlette.concurrency import run_in_threadpool

from api_schemas.scans import MOST_VIEWS
from service.api.artifacts import BINARY, AcceptHeader, is_known
from service.api.context import ApiContext, Context
from service.api.job_resources import FITS, SCANS, JobResource
from service.api.job_routes import JOB_PROBLEMS, NOT_MODIFIED, IfNoneMatch, find
from service.api.negotiation import preferred
from service.api.problems import documented, not_found
from service.blobs import BlobMissingError
from service.engine.port import JobRecord, StoredBlob
from service.engine.tenant_jobs import TenantJobs
from service.jobs.inputs import SentPicture, pictures_of

JPEG: Final = "image/jpeg"
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


_VIEW_NUMBER: Final = Path(
    ge=0, lt=MOST_VIEWS, description="The view's place in the request, from 0 on."
)


def _of_fit() -> int:
    """A fit has one picture, and its paths do not number it."""
    return 0


def _of_scan(number: Annotated[int, _VIEW_NUMBER]) -> int:
    return number


def _router(of: JobResource, *, one: str, below: str, place_in: Callable[..., int]) -> APIRouter:
    """Make the routes of the pictures of fits or scans.

    Parameters
    ----------
    one, below
        What has one picture, and its path below the job.
    place_in
        Dependency that gives the picture's place in the request, from 0 on.
    """
    router = APIRouter(prefix=f"{of.path}{of.id_below}{below}", tags=[of.tag])

    @router.get(
        "/image",
        name=of.operations["image"],
        summary=f"The picture of a {one}",
        description=f"Return the picture as it was sent; it is erased with the {of.noun}.{AS_JPEG}",
        response_class=Response,
        responses=PICTURE_ANSWERS,
    )
    async def image(
        jobs: Annotated[TenantJobs, Depends(of.jobs)],
        job_id: Annotated[UUID, of.id],
        place: Annotated[int, Depends(place_in)],
        context: Context,
        if_none_match: IfNoneMatch = None,
        accept: AcceptHeader = None,
    ) -> Response:
        record = await run_in_threadpool(find, jobs, job_id)
        sent = _picture(record, place).image
        read = partial(_content, context, record, sent)
        return await serve_stored_picture(context, sent, read, if_none_match, accept)

    @router.get(
        "/mask",
        name=of.operations["mask"],
        summary=f"The mask of a {one}",
        response_class=Response,
        responses=AS_SENT | NOT_MODIFIED | documented(*JOB_PROBLEMS),
    )
    def mask(
        jobs: Annotated[TenantJobs, Depends(of.jobs)],
        job_id: Annotated[UUID, of.id],
        place: Annotated[int, Depends(place_in)],
        context: Context,
        if_none_match: IfNoneMatch = None,
    ) -> Response:
        """Return the mask as it was sent; `not-found` if none was."""
        record = find(jobs, job_id)
        sent = _picture(record, place).mask
        if sent is None:
            raise not_found(what="mask: none was sent with this picture")
        return serve_blob(context, record, sent, if_none_match)

    return router


def _picture(record: JobRecord, place: int) -> SentPicture[StoredBlob]:
    pictures = pictures_of(record.inputs)
    if place >= len(pictures):
        raise not_found(what=f"such view: of this {record.root} there are {len(pictures)}")
    return pictures[place]


ROUTER: Final = APIRouter()
ROUTER.include_router(_router(FITS, one="fit", below="", place_in=_of_fit))
ROUTER.include_router(_router(SCANS, one="view", below="/views/{number}", place_in=_of_scan))


def serve_blob(
    context: ApiContext, record: JobRecord, blob: StoredBlob, if_none_match: str | None
) -> Response:
    """Answer with an input of a job."""
    headers = _headers(blob.digest)
    if is_known(blob.digest, if_none_match):
        return Response(status_code=304, headers=headers)
    content = _content(context, record, blob)
    return Response(content, media_type=blob.media_type, headers=headers)


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
    if is_known(tag, if_none_match):
        return Response(status_code=304, headers=headers)
    content = await run_in_threadpool(read)
    if is_converted:
        return Response(await context.estimates.jpeg(content), media_type=JPEG, headers=headers)
    return Response(content, media_type=kind, headers=headers)


def _headers(tag: str) -> dict[str, str]:
    return {"ETag": f'"{tag}"'}


def _content(context: ApiContext, record: JobRecord, blob: StoredBlob) -> bytes:
    try:
        return context.blobs.get(record.id, blob.digest)
    except BlobMissingError as error:
        raise not_found(what="such job any more") from error
