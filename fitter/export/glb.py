"""The GLB container of glTF 2.0: arrays to accessors, JSON and binary chunk to bytes.

Written directly, so that the vertex order stays ours and the same input gives the same bytes.
"""

import json
import struct
from collections.abc import Mapping
from enum import IntEnum

import numpy as np

_MAGIC = 0x46546C67
_JSON_CHUNK = 0x4E4F534A
_BINARY_CHUNK = 0x004E4942
_ALIGNMENT = 4

_COMPONENT_TYPES = {"<f4": 5126, "<u2": 5123, "<u4": 5125}
_SHAPE_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}


class Target(IntEnum):
    """What a buffer view holds."""

    VERTEX_ATTRIBUTE = 34962
    TRIANGLE_INDICES = 34963


class BinaryChunk:
    """The binary chunk while it grows: appends arrays and describes them as accessors."""

    def __init__(self) -> None:
        self._bytes = bytearray()
        self.accessors: list[dict[str, object]] = []
        self.buffer_views: list[dict[str, object]] = []

    def add(self, array: np.ndarray, *, target: Target | None, bounds: bool = False) -> int:
        """Append a (k,) or (k, d) array of float32, uint16 or uint32; return its accessor.

        Sixteen columns are a matrix, column after column. ``target`` is None for what belongs to no
        vertex and no triangle, as an animation's samples. ``bounds`` writes ``min`` and ``max``,
        which glTF demands of positions and of the times of an animation.
        """
        stored = np.ascontiguousarray(array, dtype=array.dtype.newbyteorder("<"))
        columns = stored.reshape(len(stored), -1)
        raw = stored.tobytes()
        accessor: dict[str, object] = {
            "bufferView": len(self.buffer_views),
            "componentType": _COMPONENT_TYPES[stored.dtype.newbyteorder("<").str],
            "count": len(stored),
            "type": _SHAPE_TYPES[columns.shape[1]],
        }
        if bounds:
            # Widening float32 to JSON's double keeps the bounds equal to the stored numbers.
            by_column = np.ascontiguousarray(columns.T)
            accessor["min"] = by_column.min(axis=1).tolist()
            accessor["max"] = by_column.max(axis=1).tolist()
        view: dict[str, object] = {
            "buffer": 0,
            "byteOffset": len(self._bytes),
            "byteLength": len(raw),
        }
        if target is not None:
            view["target"] = int(target)
        self.buffer_views.append(view)
        self.accessors.append(accessor)
        self._bytes += raw + b"\0" * (-len(raw) % _ALIGNMENT)
        return len(self.accessors) - 1

    def add_file(self, content: bytes) -> int:
        """Append a file as it is, as a picture of a texture; return its buffer view."""
        self.buffer_views.append(
            {"buffer": 0, "byteOffset": len(self._bytes), "byteLength": len(content)}
        )
        self._bytes += content + b"\0" * (-len(content) % _ALIGNMENT)
        return len(self.buffer_views) - 1

    def content(self) -> memoryview:
        """Everything appended so far, padded to four bytes; nothing can be added while it is held.

        No copy: an animation has 20 MB.
        """
        return memoryview(self._bytes)


def pack_glb(document: Mapping[str, object], binary: BinaryChunk) -> bytes:
    """Header, JSON chunk (padded with spaces) and binary chunk (padded with zeros)."""
    content = binary.content()
    complete = dict(document) | {
        "accessors": binary.accessors,
        "bufferViews": binary.buffer_views,
        "buffers": [{"byteLength": len(content)}],
    }
    text = json.dumps(
        complete, sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False
    ).encode()
    text += b" " * (-len(text) % _ALIGNMENT)
    total = 12 + 8 + len(text) + 8 + len(content)
    return b"".join(
        [
            struct.pack("<III", _MAGIC, 2, total),
            struct.pack("<II", len(text), _JSON_CHUNK),
            text,
            struct.pack("<II", len(content), _BINARY_CHUNK),
            content,
        ]
    )
