"""The files of a job that can be requested: as stored, or converted from what is stored.

Every GLB is also available in other mesh formats, and a result with measurements also as a table.
Converted files are never stored: an estimator writes them each time, with the same bytes.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import PurePath
from typing import Final

from api_schemas.jobs import JobState
from api_schemas.problems import problem
from api_schemas.results import Artifact
from service.api.negotiation import not_acceptable, preferred
from service.api.problems import ProblemError
from service.engine.port import JobRecord
from service.jobs.inputs import RESULT
from service.representation.csv_tables import CSV, TABLE
from service.representation.formats import (
    GLB,
    GLB_ENDING,
    MESH_FORMATS,
    MTL,
    MeshFormat,
    tag_of,
)

TEXTURE_FILES: Final = frozenset({"texture.png", "texture.jpg"})
"""What lies next to a textured mesh, that its material refers to."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Rendition:
    """A file that can be requested.

    ``source`` is the stored file that it is or is converted from; ``mesh_format`` is the format of
    a mesh that is not stored. ``tag`` identifies its bytes.
    """

    name: str
    media_type: str
    tag: str
    source: Artifact
    mesh_format: MeshFormat | None = None


def chosen_rendition(record: JobRecord, name: str, *, accept: str | None) -> Rendition:
    """Find a file by its name; for that of a GLB, in the format that ``accept`` prefers.

    Raises
    ------
    ProblemError
        404 if nothing has that name, 406 if no accepted format can be written.
    """
    there_are = {each.name: each for each in renditions(record)}
    if name not in there_are:
        raise _unknown(record, name, there_are)
    if not is_negotiated(name):
        return there_are[name]
    forms = {each.media_type: each for each in _forms_of(there_are[name].source)}
    media_type = preferred(accept, list(forms))
    if media_type is None:
        raise not_acceptable(accept, what=name, offered=list(forms))
    return forms[media_type]


def is_negotiated(name: str) -> bool:
    """Whether the answer for this name depends on the Accept header."""
    return name.endswith(GLB_ENDING)


def renditions(record: JobRecord) -> Iterator[Rendition]:
    """All files of a job that can be requested, each followed by its other formats."""
    stored = {each.name: each for each in record.artifacts}
    for artifact in record.artifacts:
        if artifact.name.endswith(GLB_ENDING):
            yield from _forms_of(artifact)
            if not TEXTURE_FILES.isdisjoint(stored):
                yield _written(artifact, MTL)
        else:
            yield _as_stored(artifact)
    if RESULT in stored and record.parent is None:
        yield Rendition(
            name=TABLE, media_type=CSV, tag=f"{stored[RESULT].sha256}-csv", source=stored[RESULT]
        )


def _forms_of(mesh: Artifact) -> Iterator[Rendition]:
    yield _as_stored(mesh)
    for each in MESH_FORMATS.values():
        yield _written(mesh, each)


def _as_stored(artifact: Artifact) -> Rendition:
    return Rendition(
        name=artifact.name,
        media_type=artifact.media_type,
        tag=artifact.sha256,
        source=artifact,
    )


def _written(mesh: Artifact, kind: MeshFormat) -> Rendition:
    return Rendition(
        name=f"{PurePath(mesh.name).stem}.{kind.ending}",
        media_type=kind.media_type,
        tag=tag_of(mesh.sha256, kind),
        source=mesh,
        mesh_format=kind,
    )


def _unknown(record: JobRecord, name: str, there_are: Mapping[str, Rendition]) -> ProblemError:
    if record.state is not JobState.SUCCEEDED:
        remedy = f"The job is {record.state}; only one that has succeeded has files."
    else:
        remedy = f"Ask for {_named(there_are)}."
    return ProblemError(
        problem("not-found", detail=f"There is no artifact '{name}' of this job.", remedy=remedy)
    )


def _named(there_are: Mapping[str, Rendition]) -> str:
    """All names, with the endings of a mesh combined: ``body_posed (.glb, .obj, .ply, .stl)``."""
    said: dict[str, list[str]] = {}
    for each in there_are.values():
        name = PurePath(each.name)
        is_mesh = each.source.media_type == GLB
        said.setdefault(name.stem if is_mesh else each.name, []).extend(
            [name.suffix] if is_mesh else []
        )
    return ", ".join(
        f"{stem} ({', '.join(endings)})" if endings else stem for stem, endings in said.items()
    )
