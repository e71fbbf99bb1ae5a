"""Files over HTTP: as stored, or written from what is stored when they are asked for.

Every GLB is also there in other mesh formats, every picture that was sent as a JPEG, and a result's
measurements as a table; they are never stored, and have the same bytes each time.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import Annotated, Any, Final

from fastapi import Depends, Header, Path, Response

from api_schemas.csv_tables import CSV, TABLE, measurements_csv_of
from api_schemas.jobs import JobState
from api_schemas.problems import shortened
from service.api.context import ApiContext
from service.api.problems import ProblemError, documented, problem_error
from service.api.requests import JSON
from service.api.storage import stored_content
from service.jobs.inputs import IMAGE, RESULT
from service.jobs.records import StoredBlob
from service.version import VERSION

GLB_ENDING: Final = ".glb"
GLB: Final = "model/gltf-binary"
"""The format that meshes are stored in."""

MESH_FORMATS: Final[Mapping[str, str]] = {
    "obj": "model/obj",
    "ply": "model/ply",
    "stl": "model/stl",
}
"""Media types by the endings of the formats that :func:`fitter.export.formats.converted` writes
from a GLB. IANA lists all but ``model/ply``, which many use."""

MATERIAL: Final[Mapping[str, str]] = {"mtl": "model/mtl"}
"""That of a textured OBJ."""

STAND_ALONE: Final = (
    "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'none'"
)
"""The policy of self-contained documents: they show what is inside, run and load nothing."""

HTML: Final = "text/html"
JPEG: Final = "image/jpeg"
PICTURES: Final = (JPEG, "image/png", "image/webp", "image/heic")
"""The kinds of pictures that are accepted."""

TEXTURE_FILES: Final = frozenset({"texture.png", "texture.jpg"})
"""Files next to a textured mesh, to which its material refers."""

OCTETS: Final = "application/octet-stream"
"""What any file comes as if it is asked for by name: some generated clients know no other."""

BINARY: Final = {"schema": {"type": "string", "format": "binary"}}
NOT_MODIFIED: Final[dict[int | str, dict[str, Any]]] = {
    304: {"description": "Not changed since the given ETag."}
}

IfNoneMatch = Annotated[str | None, Header()]

# OpenAPI ignores headers of this name: the responses' media types say enough.
AcceptHeader = Annotated[str, Header(alias="Accept", include_in_schema=False)]


@dataclass(frozen=True, slots=True)
class FileHeaders:
    """The headers that say how a file is wanted."""

    accept: AcceptHeader = ""
    if_none_match: IfNoneMatch = None


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

FORMATS: Final = """

A mesh has metres with y up, and vertices and triangles in the body model's order (an STL has \
triangles alone). A picture that was sent comes as a JPEG, upright and of the same size, where \
`Accept` names `image/jpeg` and not its kind: most browsers cannot show HEIC."""


def file_answers(*media_types: str, problems: Sequence[str]) -> dict[int | str, dict[str, Any]]:
    """Describe the answers to a request for a file: of these types, a mesh or JSON.

    ``problems`` are those that may keep a caller from what has the file.
    """
    meshes = (GLB, *MESH_FORMATS.values(), *MATERIAL.values())
    content = dict.fromkeys((OCTETS, *media_types, *meshes, CSV), BINARY)
    return (
        {
            200: {
                "description": "The file.",
                "content": content | {JSON: {"schema": {"type": "object"}}},
            },
        }
        | NOT_MODIFIED
        | documented(*problems)
    )


def is_known(tag: str, if_none_match: str | None) -> bool:
    """Return true if the client already has these bytes."""
    return if_none_match is not None and (f'"{tag}"' in if_none_match or if_none_match == "*")


@dataclass(frozen=True, slots=True, kw_only=True)
class Rendition:
    """A file that can be requested.

    ``source`` is the stored file that it is or is written from; ``mesh_format`` is the ending of a
    mesh that is not stored. ``tag`` identifies its bytes.
    """

    media_type: str
    tag: str
    source: StoredBlob
    mesh_format: str | None = None


def as_stored(file: StoredBlob) -> Rendition:
    """A file as it is stored."""
    return Rendition(media_type=file.media_type, tag=file.digest, source=file)


def chosen_rendition(
    files: Mapping[str, StoredBlob], name: str, *, state: JobState, accept: str
) -> Rendition:
    """Find a file by its name; a picture that was sent, as ``accept`` names it.

    ``state`` is that of the fit or product that has these files.

    Raises
    ------
    ProblemError
        If nothing has that name.
    """
    there_are = dict(renditions(files))
    if name not in there_are:
        raise _unknown(name, files, state)
    if PurePosixPath(name).name == IMAGE:
        return picture_rendition(files[name], accept=accept)
    return there_are[name]


def picture_rendition(picture: StoredBlob, *, accept: str) -> Rendition:
    """A picture as it was sent, or as a JPEG where that alone is named as accepted."""
    sent, tag = picture.media_type, picture.digest
    if JPEG in accept and not any(kind in accept for kind in (sent, "image/*", "*/*")):
        return Rendition(media_type=JPEG, tag=f"{tag}-jpeg", source=picture)
    return Rendition(media_type=sent, tag=tag, source=picture)


def renditions(files: Mapping[str, StoredBlob]) -> Iterator[tuple[str, Rendition]]:
    """All files that can be requested by their names, each followed by its other formats."""
    written = MESH_FORMATS if TEXTURE_FILES.isdisjoint(files) else {**MESH_FORMATS, **MATERIAL}
    for name, file in files.items():
        yield name, as_stored(file)
        if name.endswith(GLB_ENDING):
            for ending, media_type in written.items():
                yield (
                    f"{name.removesuffix(GLB_ENDING)}.{ending}",
                    Rendition(
                        media_type=media_type,
                        # Another release may write other bytes.
                        tag=f"{file.digest}-{ending}-{VERSION}",
                        source=file,
                        mesh_format=ending,
                    ),
                )
    if RESULT in files:
        document = files[RESULT]
        yield TABLE, Rendition(media_type=CSV, tag=f"{document.digest}-csv", source=document)


def _unknown(name: str, files: Mapping[str, StoredBlob], state: JobState) -> ProblemError:
    there_is = f"Ask for {', '.join(files)}." if files else "Nothing is there to be asked for."
    if state is not JobState.SUCCEEDED:
        there_is += f" The state is {state}; only what has succeeded has files of a result."
    return problem_error(
        slug="not-found", detail=f"There is no file '{shortened(name)}' here.", remedy=there_is
    )


async def answer_file(
    context: ApiContext, scope: str, rendition: Rendition, wanted: Wanted
) -> Response:
    """Answer with a file of a scope, unless the client has it already."""
    headers = {"ETag": f'"{rendition.tag}"', "Vary": "Accept"}
    if rendition.media_type == HTML:
        headers["Content-Security-Policy"] = STAND_ALONE
    if is_known(rendition.tag, wanted.if_none_match):
        return Response(status_code=304, headers=headers)
    stored = await stored_content(context.blobs, scope, rendition.source)
    content = await _converted(context, stored, rendition)
    kind, accept = rendition.media_type, wanted.accept
    sent_as = OCTETS if OCTETS in accept and kind not in accept else kind
    return Response(content, media_type=sent_as, headers=headers)


async def _converted(context: ApiContext, stored: bytes, rendition: Rendition) -> bytes:
    if rendition.mesh_format is not None:
        return await context.estimators.convert(stored, rendition.mesh_format)
    if rendition.media_type == rendition.source.media_type:
        return stored
    if rendition.media_type == JPEG:
        return await context.estimators.jpeg(stored)
    return measurements_csv_of(stored)
