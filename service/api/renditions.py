"""The files that can be requested: as stored, or converted from what is stored.

Every GLB is also available in other mesh formats, every picture that was sent as a JPEG, and a
result's measurements as a table. Converted files are never stored: they are written each time, with
the same bytes.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import PurePosixPath
from typing import Final

from api_schemas.jobs import JobState
from api_schemas.problems import problem
from service.api.negotiation import not_acceptable, preferred
from service.api.problems import ProblemError
from service.jobs.inputs import IMAGE, RESULT
from service.jobs.records import StoredBlob
from service.representation.csv_tables import CSV, TABLE
from service.representation.formats import (
    GLB,
    GLB_ENDING,
    MESH_FORMATS,
    MTL,
    MeshFormat,
    tag_of,
)

JPEG: Final = "image/jpeg"
TEXTURE_FILES: Final = frozenset({"texture.png", "texture.jpg"})
"""What lies next to a textured mesh, that its material refers to."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Rendition:
    """A file that can be requested, and the name by which it is.

    ``source`` is the stored file that it is or is converted from; ``mesh_format`` is the format of
    a mesh that is not stored. ``tag`` identifies its bytes.
    """

    name: str
    media_type: str
    tag: str
    source: StoredBlob
    mesh_format: MeshFormat | None = None


def chosen_rendition(
    files: Mapping[str, StoredBlob], name: str, *, state: JobState, accept: str | None
) -> Rendition:
    """Find a file by its name; for that of a GLB or a picture, in the format ``accept`` prefers.

    ``state`` is that of the fit or product that has these files.

    Raises
    ------
    ProblemError
        404 if nothing has that name, 406 if no accepted format can be written.
    """
    there_are = {each.name: each for each in renditions(files)}
    if name not in there_are:
        raise _unknown(name, there_are, state)
    if is_picture(name):
        return picture_rendition(name, files[name], accept=accept)
    if not is_negotiated(name):
        return there_are[name]
    forms = {each.media_type: each for each in _forms_of(name, files[name])}
    media_type = preferred(accept, list(forms))
    if media_type is None:
        raise not_acceptable(accept, what=name, offered=list(forms))
    return replace(forms[media_type], name=name)


def picture_rendition(name: str, picture: StoredBlob, *, accept: str | None) -> Rendition:
    """A picture as it was sent, or as a JPEG where that is preferred."""
    sent = _as_stored(name, picture)
    if picture.media_type == JPEG or preferred(accept, [picture.media_type, JPEG]) != JPEG:
        return sent
    return Rendition(name=name, media_type=JPEG, tag=f"{picture.digest}-jpeg", source=picture)


def is_picture(name: str) -> bool:
    """Whether this is the name of a picture that was sent."""
    return PurePosixPath(name).name == IMAGE


def is_negotiated(name: str) -> bool:
    """Whether the answer for this name depends on the Accept header."""
    return name.endswith(GLB_ENDING) or is_picture(name)


def renditions(files: Mapping[str, StoredBlob]) -> Iterator[Rendition]:
    """All files that can be requested, each followed by its other formats."""
    for name, file in files.items():
        if name.endswith(GLB_ENDING):
            yield from _forms_of(name, file)
            if not TEXTURE_FILES.isdisjoint(files):
                yield _written(name, file, MTL)
        else:
            yield _as_stored(name, file)
    if RESULT in files:
        document = files[RESULT]
        yield Rendition(name=TABLE, media_type=CSV, tag=f"{document.digest}-csv", source=document)


def _forms_of(name: str, mesh: StoredBlob) -> Iterator[Rendition]:
    yield _as_stored(name, mesh)
    for each in MESH_FORMATS.values():
        yield _written(name, mesh, each)


def _as_stored(name: str, file: StoredBlob) -> Rendition:
    return Rendition(name=name, media_type=file.media_type, tag=file.digest, source=file)


def _written(name: str, mesh: StoredBlob, kind: MeshFormat) -> Rendition:
    return Rendition(
        name=f"{name.removesuffix(GLB_ENDING)}.{kind.ending}",
        media_type=kind.media_type,
        tag=tag_of(mesh.digest, kind),
        source=mesh,
        mesh_format=kind,
    )


def _unknown(name: str, there_are: Mapping[str, Rendition], state: JobState) -> ProblemError:
    there_is = f"Ask for {_named(there_are)}." if there_are else "Nothing is there to be asked for."
    if state is not JobState.SUCCEEDED:
        there_is += f" The state is {state}; only what has succeeded has files of a result."
    return ProblemError(
        problem(
            "not-found",
            detail=f"There is no file '{name}' here.",
            remedy=there_is,
        )
    )


def _named(there_are: Mapping[str, Rendition]) -> str:
    """All names, with the endings of a mesh combined: ``body_canonical (.glb, .obj, .stl)``."""
    said: dict[str, list[str]] = {}
    for each in there_are.values():
        name = PurePosixPath(each.name)
        is_mesh = each.source.media_type == GLB
        said.setdefault(str(name.with_suffix("")) if is_mesh else each.name, []).extend(
            [name.suffix] if is_mesh else []
        )
    return ", ".join(
        f"{stem} ({', '.join(endings)})" if endings else stem for stem, endings in said.items()
    )
