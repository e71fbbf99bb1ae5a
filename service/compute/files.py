"""The files of a result: their media types, and the result document that lists them."""

import hashlib
from collections.abc import Mapping
from pathlib import PurePath
from typing import Final

from api_schemas.results import FitResult, ResultFile
from service.jobs.inputs import RESULT

MEDIA_TYPES: Final[Mapping[str, str]] = {
    ".glb": "model/gltf-binary",
    ".png": "image/png",
    ".jpg": "image/jpeg",
    ".json": "application/json",
    ".csv": "text/csv",
    ".html": "text/html",
    ".npz": "application/zip",
    ".webp": "image/webp",
}


def describe_file(name: str, content: bytes, *, digest: str | None = None) -> ResultFile:
    """Describe a file by name, kind, size and content, whose digest may be known."""
    return ResultFile(
        name=name,
        media_type=MEDIA_TYPES[PurePath(name).suffix],
        size=len(content),
        sha256=digest or hashlib.sha256(content).hexdigest(),
    )


def with_result_document(result: FitResult, files: Mapping[str, bytes]) -> dict[str, bytes]:
    """Add ``result.json``, which lists all the other files."""
    listed = tuple(describe_file(name, content) for name, content in sorted(files.items()))
    document = result.model_copy(update={"files": listed}).model_dump_json(indent=1).encode()
    return {**files, RESULT: document}
