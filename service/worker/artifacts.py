"""The files of a result: their media types, and the result document that lists them."""

import hashlib
from collections.abc import Mapping
from pathlib import PurePath
from typing import Final

from api_schemas.derivation_kinds.base import DerivedFiles
from api_schemas.results import Artifact, FitResult
from api_schemas.scans import ScanResult
from service.jobs.inputs import RESULT

MEDIA_TYPES: Final[Mapping[str, str]] = {
    ".glb": "model/gltf-binary",
    ".png": "image/png",
    ".jpg": "image/jpeg",
    ".json": "application/json",
    ".csv": "text/csv",
    ".npz": "application/zip",
    ".webp": "image/webp",
}


def describe_artifact(name: str, content: bytes, *, digest: str | None = None) -> Artifact:
    """Describe a file by name, kind, size and content, whose digest may be known."""
    return Artifact(
        name=name,
        media_type=MEDIA_TYPES[PurePath(name).suffix],
        size=len(content),
        sha256=digest or hashlib.sha256(content).hexdigest(),
    )


def with_result_document(
    result: FitResult | ScanResult | DerivedFiles, artifacts: Mapping[str, bytes]
) -> dict[str, bytes]:
    """Add ``result.json``, which lists all the other files."""
    listed = result.model_copy(
        update={
            "artifacts": tuple(
                describe_artifact(name, content) for name, content in sorted(artifacts.items())
            )
        }
    )
    document = listed.model_dump_json(indent=1).encode()
    return dict(artifacts) | {RESULT: document}
