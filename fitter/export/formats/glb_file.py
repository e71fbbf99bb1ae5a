"""The GLB container as :mod:`fitter.export.glb` writes it, read: JSON and arrays."""

import json
import struct
from dataclasses import dataclass
from typing import Any

import numpy as np

_HEADER_BYTES = 12
_CHUNK_HEADER_BYTES = 8
_COMPONENT_TYPES = {5126: np.dtype("<f4"), 5123: np.dtype("<u2"), 5125: np.dtype("<u4")}
_COLUMNS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


@dataclass(frozen=True, slots=True, eq=False)
class GlbFile:
    """The JSON of a file and its binary chunk."""

    document: dict[str, Any]
    binary: memoryview

    def array(self, accessor: int) -> np.ndarray:
        """(k, d) values of an accessor, (k, 1) where they are single numbers."""
        described = self.document["accessors"][accessor]
        columns = _COLUMNS[described["type"]]
        content = self.view(described["bufferView"])
        values = np.frombuffer(content, dtype=_COMPONENT_TYPES[described["componentType"]])
        return values[: described["count"] * columns].reshape(-1, columns)

    def view(self, index: int) -> memoryview:
        """The bytes of a buffer view."""
        described = self.document["bufferViews"][index]
        start = described.get("byteOffset", 0)
        return self.binary[start : start + described["byteLength"]]


def read_glb(content: bytes) -> GlbFile:
    """Read a file of one JSON chunk and one binary chunk."""
    (text_bytes,) = struct.unpack_from("<I", content, _HEADER_BYTES)
    text = _HEADER_BYTES + _CHUNK_HEADER_BYTES
    binary = text + text_bytes + _CHUNK_HEADER_BYTES
    document = json.loads(content[text : text + text_bytes])
    return GlbFile(document, memoryview(content)[binary:])
