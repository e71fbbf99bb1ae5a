"""Responses with a file: as stored or in the preferred format, whole or in part.

Parts are ranges of bytes (RFC 9110 14).
"""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Final

from fastapi import Depends, Header, Path, Response
from starlette.concurrency import run_in_threadpool

from api_schemas.problems import problem
from service.api.context import ApiContext
from service.api.json_bodies import JSON
from service.api.problems import ProblemError, documented, not_found
from service.api.renditions import JPEG, Rendition, is_negotiated
from service.api.security_headers import STAND_ALONE
from service.jobs.blobs import BlobMissingError
from service.jobs.records import StoredBlob
from service.representation.csv_tables import CSV, measurements_csv_of
from service.representation.formats import GLB, MESH_FORMATS, MTL

HTML: Final = "text/html"
PICTURES: Final = (JPEG, "image/png", "image/webp", "image/heic")
"""The kinds of pictures that are accepted."""

BINARY: Final = {"schema": {"type": "string", "format": "binary"}}
NOT_MODIFIED: Final[dict[int | str, dict[str, Any]]] = {
    304: {"description": "Not changed since the given ETag."}
}

IfNoneMatch = Annotated[str | None, Header()]

# OpenAPI ignores headers of this name: the responses' media types say enough.
AcceptHeader = Annotated[str | None, Header(alias="Accept", include_in_schema=False)]


@dataclass(frozen=True, slots=True)
class FileHeaders:
    """The headers that say how a file is wanted."""

    accept: AcceptHeader = None
    if_none_match: IfNoneMatch = None
    range: Annotated[str | None, Header(alias="Range")] = None
    if_range: Annotated[
        str | None,
        Header(
            description="The `ETag` of the file that `Range` is a part of: of another, the whole."
        ),
    ] = None


Wanted = Annotated[FileHeaders, Depends()]

FileName = Annotated[
    str,
    Path(
        description=(
            "A name of `links.files`. Where that is a `.glb`, the same stem with "
            f"{', '.join(f'`.{ending}`' for ending in MESH_FORMATS)} is the mesh in that format, "
            "written when it is asked for; of a textured one `.mtl` is the material of the OBJ. "
            "`measurements.csv` is there with a result."
        ),
    ),
]

NEGOTIATION: Final = """

A `.glb` is answered in the format that `Accept` wants most: GLB, OBJ, PLY or STL; GLB for `*/*`,
for `application/octet-stream` and without the header, 406 where none of them is accepted. Whatever
the format, metres with y up, and vertices and triangles in the body model's order (an STL has
triangles alone). A picture that was sent comes as a JPEG, upright and of the same size, where that
is preferred: most browsers cannot show HEIC. All other names ignore the header."""


def file_answers(*media_types: str, problems: Sequence[str]) -> dict[int | str, dict[str, Any]]:
    """Describe the answers to a request for a file: of these types, a mesh or JSON.

    ``problems`` are those that may keep a caller from what has the file.
    """
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
        | documented("not-acceptable", "range-not-satisfiable", "unusable-input", *problems)
    )


async def answer_file(
    context: ApiContext, rendition: Rendition, read: Callable[[StoredBlob], bytes], wanted: Wanted
) -> Response:
    """Answer with a file, or a part of it; ``read`` reads what is stored."""
    headers = {"ETag": f'"{rendition.tag}"', "Accept-Ranges": "bytes"}
    if is_negotiated(rendition.name):
        headers["Vary"] = "Accept"
    if rendition.media_type == HTML:
        headers["Content-Security-Policy"] = STAND_ALONE
    if is_known(rendition.tag, wanted.if_none_match):
        return Response(status_code=304, headers=headers)
    stored = await run_in_threadpool(read, rendition.source)
    return whole_or_part(
        await _converted(context, stored, rendition),
        media_type=rendition.media_type,
        headers=headers,
        range_header=wanted.range,
        if_range=wanted.if_range,
    )


def answer_blob(
    context: ApiContext, scope: str, blob: StoredBlob, if_none_match: str | None
) -> Response:
    """Answer with a stored document as it is."""
    headers = {"ETag": f'"{blob.digest}"'}
    if is_known(blob.digest, if_none_match):
        return Response(status_code=304, headers=headers)
    content = stored_content(context, scope, blob)
    return Response(content, media_type=blob.media_type, headers=headers)


def is_known(tag: str, if_none_match: str | None) -> bool:
    """Whether the client already has these bytes."""
    return if_none_match is not None and (f'"{tag}"' in if_none_match or if_none_match == "*")


def stored_content(context: ApiContext, scope: str, blob: StoredBlob) -> bytes:
    """Read a file of a fit; 404 if it has been erased in the meantime."""
    try:
        return context.blobs.get(scope, blob.digest)
    except BlobMissingError as error:
        raise not_found(what="such fit any more") from error


async def _converted(context: ApiContext, stored: bytes, rendition: Rendition) -> bytes:
    if rendition.mesh_format is not None:
        return await context.estimates.convert(stored, rendition.mesh_format)
    if rendition.media_type == rendition.source.media_type:
        return stored
    if rendition.media_type == JPEG:
        return await context.estimates.jpeg(stored)
    return measurements_csv_of(stored)


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
