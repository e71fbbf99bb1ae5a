"""Responses with a result: its document, or a file in the preferred format, whole or in part."""

from functools import partial
from typing import Annotated, Any, Final
from uuid import UUID

from fastapi import Header, Path, Response
from starlette.concurrency import run_in_threadpool

from api_schemas.jobs import JobState
from api_schemas.problems import Problem, problem
from api_schemas.results import Artifact
from service.api.byte_ranges import whole_or_part
from service.api.context import ApiContext
from service.api.job_routes import JOB_PROBLEMS, NOT_MODIFIED, find
from service.api.json_bodies import JSON
from service.api.problems import ProblemError, documented, not_found
from service.api.renditions import Rendition, chosen_rendition, is_negotiated
from service.api.security_headers import STAND_ALONE
from service.blobs import BlobMissingError
from service.engine.port import JobRecord, TenantJobs
from service.jobs.inputs import RESULT
from service.representation.csv_tables import CSV, measurements_csv_of
from service.representation.formats import GLB, MESH_FORMATS, MTL

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
            "(`.usdz` where the service has the extra `usdz` installed), written when it is asked "
            "for; of a textured one `.mtl` is the material of the OBJ. `measurements.csv` is "
            "there with a fit and with a combined body."
        ),
    ),
]

NEGOTIATION: Final = """

A `.glb` is answered in the format that `Accept` wants most: GLB, OBJ, PLY, STL or USDZ; GLB for
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


def serve_result(context: ApiContext, record: JobRecord, *, if_none_match: str | None) -> Response:
    """Answer with the result document; 409 if the job has none."""
    document = next((each for each in record.artifacts if each.name == RESULT), None)
    if record.state is not JobState.SUCCEEDED or document is None:
        raise ProblemError(no_result(record))
    headers = file_headers(document.sha256)
    if is_known(document.sha256, if_none_match):
        return Response(status_code=304, headers=headers)
    content = stored_content(context, record, document)
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
