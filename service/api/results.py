"""What a job leaves behind: the result document and its files."""

import re
from dataclasses import dataclass
from typing import Annotated, Any, Final
from uuid import UUID

from fastapi import APIRouter, Header, Response

from api_schemas.jobs import JobState
from api_schemas.problems import Problem, problem
from api_schemas.results import Artifact, FitResult
from service.api.context import ApiContext, Context
from service.api.job_routes import JOB_PROBLEMS, NOT_MODIFIED, IfNoneMatch, find
from service.api.problems import ProblemError, documented, not_found
from service.api.security_headers import STAND_ALONE
from service.blobs import BlobMissingError
from service.engine.port import JobRecord
from service.inputs import RESULT

ROUTER: Final = APIRouter(prefix="/v1/fits", tags=["results"])

HTML: Final = "text/html"
_BINARY: Final = {"schema": {"type": "string", "format": "binary"}}

RangeHeader = Annotated[str | None, Header(alias="Range")]


def file_answers(*media_types: str) -> dict[int | str, dict[str, Any]]:
    """Describe the answers to whoever asks for a file of these types, or of JSON."""
    files = dict.fromkeys(media_types, _BINARY)
    return (
        {
            200: {
                "description": "The whole file.",
                "content": files | {"application/json": {"schema": {"type": "object"}}},
            },
            206: {
                "description": "The part asked for.",
                # Part of a JSON file is not JSON.
                "content": files | {"application/json": _BINARY},
            },
        }
        | NOT_MODIFIED
        | documented("range-not-satisfiable", *JOB_PROBLEMS)
    )


@ROUTER.get(
    "/{fit_id}/result",
    summary="The result document",
    responses={200: {"model": FitResult}} | NOT_MODIFIED | documented("no-result", *JOB_PROBLEMS),
)
def result(fit_id: UUID, context: Context, if_none_match: IfNoneMatch = None) -> Response:
    """Return camera, pose, shape, light, measurements, what was assumed, and the files' names."""
    return serve_result(context, find(context.jobs, fit_id), if_none_match=if_none_match)


@ROUTER.get(
    "/{fit_id}/artifacts/{name}",
    summary="A file of the result",
    response_class=Response,
    responses=file_answers("model/gltf-binary", "image/png", "application/zip"),
)
def artifact(
    fit_id: UUID,
    name: str,
    context: Context,
    if_none_match: IfNoneMatch = None,
    range_header: RangeHeader = None,
) -> Response:
    """Return a file: `body_posed.glb`, `overlay.png` and so on, as the job's links name them."""
    record = find(context.jobs, fit_id)
    return serve_file(context, record, name, range_header=range_header, if_none_match=if_none_match)


@dataclass(frozen=True, slots=True)
class ByteRange:
    """First and last byte, both included."""

    first: int
    last: int


def parse_range(header: str, size: int) -> ByteRange | None:
    """Read a Range header of one range; None where the whole is to be sent instead.

    A header that is not understood, or asks for several ranges, is ignored (RFC 9110 14.2).

    Raises
    ------
    ValueError
        If the range lies outside the ``size`` bytes there are.
    """
    found = re.fullmatch(r"bytes=(\d{0,18})-(\d{0,18})", header.strip())
    if found is None or not (found[1] or found[2]):
        return None
    if not found[1]:
        length = min(int(found[2]), size)
        first, last = size - length, size - 1
    else:
        first = int(found[1])
        last = min(int(found[2]), size - 1) if found[2] else size - 1
        if found[2] and int(found[2]) < first:
            return None
    if first > last:
        message = f"bytes {header} of {size}"
        raise ValueError(message)
    return ByteRange(first, last)


def serve_result(context: ApiContext, record: JobRecord, *, if_none_match: str | None) -> Response:
    """Answer with the result document; 409 if the job has none."""
    if record.state is not JobState.SUCCEEDED:
        raise ProblemError(no_result(record))
    return serve_file(context, record, RESULT, range_header=None, if_none_match=if_none_match)


def serve_file(
    context: ApiContext,
    record: JobRecord,
    name: str,
    *,
    range_header: str | None,
    if_none_match: str | None,
) -> Response:
    """Answer with a file of a job's result, or a part of it; 404 if there is no such file."""
    listed = _listed(record, name)
    headers = {
        "ETag": f'"{listed.sha256}"',
        "Cache-Control": "private, immutable, max-age=31536000",
        "Accept-Ranges": "bytes",
    }
    if listed.media_type == HTML:
        headers["Content-Security-Policy"] = STAND_ALONE
    if if_none_match is not None and (listed.sha256 in if_none_match or if_none_match == "*"):
        return Response(status_code=304, headers=headers)
    try:
        content = context.blobs.get(record.id, listed.sha256)
    except BlobMissingError as error:
        raise not_found(what="such job any more") from error
    if range_header is None:
        return Response(content, media_type=listed.media_type, headers=headers)
    try:
        part = parse_range(range_header, listed.size)
    except ValueError as error:
        raise ProblemError(
            problem(
                "range-not-satisfiable",
                detail=f"The file has {listed.size} bytes.",
                remedy="Ask for bytes it has.",
                field="Range",
            ),
            headers={"Content-Range": f"bytes */{listed.size}"},
        ) from error
    if part is None:
        return Response(content, media_type=listed.media_type, headers=headers)
    headers["Content-Range"] = f"bytes {part.first}-{part.last}/{listed.size}"
    return Response(
        content[part.first : part.last + 1],
        status_code=206,
        media_type=listed.media_type,
        headers=headers,
    )


def _listed(record: JobRecord, name: str) -> Artifact:
    for each in record.artifacts:
        if each.name == name:
            return each
    raise not_found(what=f"artifact '{name}' of this job")


def no_result(record: JobRecord) -> Problem:
    """Say why a job has no result."""
    if record.problem is not None:
        return problem(
            "no-result",
            code=record.problem.code,
            field=record.problem.field,
            detail=f"The job {record.state}: {record.problem.detail}",
            remedy=record.problem.remedy,
        )
    canceled = record.state is JobState.CANCELED
    return problem(
        "no-result",
        detail=f"The job is {record.state}.",
        remedy="Send it again." if canceled else "Wait until it has succeeded; follow its events.",
    )
