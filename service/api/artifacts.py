"""Responses with a result: its document, or a file in the preferred format, whole or in part.

Parts are ranges of bytes (RFC 9110 14).
"""

import hashlib
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import Annotated, Any, Final
from uuid import UUID

from fastapi import Header, Path, Response
from pydantic import BaseModel
from starlette.concurrency import run_in_threadpool

from api_schemas.jobs import JobState
from api_schemas.problems import Problem, problem
from api_schemas.results import Artifact, ResultPart
from service.api.context import ApiContext
from service.api.job_routes import JOB_PROBLEMS, NOT_MODIFIED, find
from service.api.json_bodies import JSON
from service.api.problems import ProblemError, documented, not_found
from service.api.renditions import Rendition, chosen_rendition, is_negotiated
from service.api.security_headers import STAND_ALONE
from service.blobs import BlobMissingError
from service.engine.port import JobRecord
from service.engine.tenant_jobs import TenantJobs
from service.jobs.inputs import RESULT
from service.representation.csv_tables import CSV, measurements_csv_of
from service.representation.formats import GLB, MESH_FORMATS, MTL
from service.representation.results import result_json

HTML: Final = "text/html"
BINARY: Final = {"schema": {"type": "string", "format": "binary"}}

RangeHeader = Annotated[str | None, Header(alias="Range")]
IfRange = Annotated[
    str | None,
    Header(description="The `ETag` of the file that `Range` is a part of: of another, the whole."),
]

# OpenAPI ignores headers of this name: the responses' media types say enough.
AcceptHeader = Annotated[str | None, Header(alias="Accept", include_in_schema=False)]

ArtifactName = Annotated[
    str,
    Path(
        description=(
            "A name of the job's `links.artifacts`. Where that is a `.glb`, the same stem with "
            f"{', '.join(f'`.{ending}`' for ending in MESH_FORMATS)} is the mesh in that format "
            "written when it is asked for; of a textured one `.mtl` is the material of the OBJ. "
            "`measurements.csv` is there with a fit."
        ),
    ),
]

NEGOTIATION: Final = """

A `.glb` is answered in the format that `Accept` wants most: GLB, OBJ, PLY or STL; GLB for
`*/*`, for `application/octet-stream` and without the header, 406 where none of them is accepted.
All other names ignore it. Whatever the format, metres with y up, and vertices and triangles in
the body model's order (an STL has triangles alone). Of an animation the other formats show the
first frame."""


def file_answers(*media_types: str) -> dict[int | str, dict[str, Any]]:
    """Describe the answers to a request for a file: of these types, a mesh or JSON."""
    meshes = (GLB, *(each.media_type for each in (*MESH_FORMATS.values(), MTL)))
    files = dict.fromkeys((*media_types, *meshes, CSV), BINARY)
    return (
        {
            200: {
                "description": "The whole file.",
                "content": files | {JSON: {"schema": {"type": "object"}}},
            },
            206: {
                "description": "The part asked for.",
                # Part of a JSON file is not JSON.
                "content": files | {JSON: BINARY},
            },
        }
        | NOT_MODIFIED
        | documented("not-acceptable", "range-not-satisfiable", *JOB_PROBLEMS)
    )


async def answer_artifact(
    context: ApiContext,
    jobs: TenantJobs,
    job_id: UUID,
    name: str,
    *,
    accept: str | None,
    range_header: str | None,
    if_range: str | None,
    if_none_match: str | None,
) -> Response:
    """Answer with a file of a job, or a part of it; 404 if there is no such file."""
    record = await run_in_threadpool(find, jobs, job_id)
    rendition = chosen_rendition(record, name, accept=accept)
    headers = file_headers(rendition.tag)
    if is_negotiated(name):
        headers["Vary"] = "Accept"
    if rendition.media_type == HTML:
        headers["Content-Security-Policy"] = STAND_ALONE
    if is_known(rendition.tag, if_none_match):
        return Response(status_code=304, headers=headers)
    return whole_or_part(
        await _content(context, record, rendition),
        media_type=rendition.media_type,
        headers=headers,
        range_header=range_header,
        if_range=if_range,
    )


def serve_result(
    context: ApiContext,
    record: JobRecord,
    *,
    kind: type[BaseModel],
    included: frozenset[ResultPart],
    if_none_match: str | None,
) -> Response:
    """Answer with the result document of this type; 409 if the job has none."""
    document = next((each for each in record.artifacts if each.name == RESULT), None)
    if record.state is not JobState.SUCCEEDED or document is None:
        raise ProblemError(no_result(record))
    content = result_json(stored_content(context, record, document), kind=kind, included=included)
    tag = hashlib.sha256(content).hexdigest()
    headers = {"ETag": f'"{tag}"'}
    if is_known(tag, if_none_match):
        return Response(status_code=304, headers=headers)
    return Response(content, media_type=document.media_type, headers=headers)


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


def file_headers(tag: str) -> dict[str, str]:
    """The headers that every file has."""
    return {
        "ETag": f'"{tag}"',
        "Accept-Ranges": "bytes",
    }


def is_known(tag: str, if_none_match: str | None) -> bool:
    """Whether the client already has these bytes."""
    return if_none_match is not None and (f'"{tag}"' in if_none_match or if_none_match == "*")


def stored_content(context: ApiContext, record: JobRecord, artifact: Artifact) -> bytes:
    """Read a file of a job; 404 if it has been erased in the meantime."""
    try:
        return context.blobs.get(record.id, artifact.sha256)
    except BlobMissingError as error:
        raise not_found(what="such job any more") from error


async def _content(context: ApiContext, record: JobRecord, rendition: Rendition) -> bytes:
    stored = await run_in_threadpool(partial(stored_content, context, record, rendition.source))
    if rendition.mesh_format is not None:
        return await context.estimates.convert(stored, rendition.mesh_format)
    if rendition.media_type == CSV and rendition.source.media_type != CSV:
        return measurements_csv_of(stored)
    return stored


@dataclass(frozen=True, slots=True)
class ByteRange:
    """First and last byte, both included."""

    first: int
    last: int


def parse_range(header: str, size: int) -> ByteRange | None:
    """Read a Range header of one range; None if the whole file is to be sent instead.

    A header that is not understood, or asks for several ranges, is ignored (RFC 9110 14.2).

    Raises
    ------
    ValueError
        If the range lies outside the file's ``size`` bytes.
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


def whole_or_part(
    content: bytes,
    *,
    media_type: str,
    headers: Mapping[str, str],
    range_header: str | None,
    if_range: str | None,
) -> Response:
    """Answer with a file, or with the requested part of it; 416 if it has no such part.

    A part is sent only if ``if_range`` names this very file, else the whole. Files are sent without
    a date, so a date in ``if_range`` never matches (RFC 9110 13.1.5).
    """
    of_another = if_range not in (None, headers["ETag"])
    wanted = None if of_another else range_header
    try:
        part = None if wanted is None else parse_range(wanted, len(content))
    except ValueError as error:
        raise ProblemError(
            problem(
                "range-not-satisfiable",
                detail=f"The file has {len(content)} bytes.",
                remedy="Ask for bytes it has.",
                field="Range",
            ),
            headers={"Content-Range": f"bytes */{len(content)}"},
        ) from error
    if part is None:
        return Response(content, media_type=media_type, headers=dict(headers))
    return Response(
        content[part.first : part.last + 1],
        status_code=206,
        media_type=media_type,
        headers=dict(headers) | {"Content-Range": f"bytes {part.first}-{part.last}/{len(content)}"},
    )
