"""The mesh formats available besides GLB. They are written on request.

Only GLB files are stored; the others are made from one by
:func:`fitter.export.formats.converted`, which no process of the API can load. What the API needs to
know about a format is here.
"""

import hashlib
import importlib.metadata
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Final

GLB_ENDING: Final = ".glb"
GLB: Final = "model/gltf-binary"

WRITER_VERSION: Final = 1
"""Raise this whenever :mod:`fitter.export.formats` writes different bytes."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshFormat:
    """A format; ``library`` is the distribution whose version its bytes depend on, if any."""

    ending: str
    media_type: str
    library: str | None = None


OBJ: Final = MeshFormat(ending="obj", media_type="model/obj")
PLY: Final = MeshFormat(ending="ply", media_type="model/ply", library="trimesh")
STL: Final = MeshFormat(ending="stl", media_type="model/stl", library="trimesh")
MTL: Final = MeshFormat(ending="mtl", media_type="model/mtl")
"""Not a mesh but the material of a textured OBJ."""

MESH_FORMATS: Final[Mapping[str, MeshFormat]] = {each.ending: each for each in (OBJ, PLY, STL)}
"""By their endings. IANA lists all but ``model/ply``, which many use."""


@cache
def tag_of(sha256: str, kind: MeshFormat) -> str:
    """The tag that identifies the bytes of a GLB with this digest when written in a format."""
    version = "" if kind.library is None else importlib.metadata.version(kind.library)
    said = f"{sha256} {kind.ending} {WRITER_VERSION} {version}"
    return hashlib.sha256(said.encode()).hexdigest()
