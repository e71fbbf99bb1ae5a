"""The GLB container of glTF 2.0: arrays to accessors, JSON and binary chunk to bytes.

Written directly, so that the vertex order stays ours and the same input gives the same bytes.
"""

import json
import struct
from collections.abc import Mapping, Sequence
from enum import IntEnum, StrEnum
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from typing import Any

import numpy as np

from fitter.body.model import BodyModel

_MAGIC = 0x46546C67
_JSON_CHUNK = 0x4E4F534A
_BINARY_CHUNK = 0x004E4942
_ALIGNMENT = 4

_COMPONENT_TYPES = {"<f4": 5126, "<u2": 5123, "<u4": 5125}
_SHAPE_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}


class Target(IntEnum):
    """Content of a buffer view."""

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


Node = dict[str, Any]
"""A node as glTF has it; the ids in it are places in the list of nodes."""


class Frame(StrEnum):
    """The axes of a file, as its extras say them. All are right-handed, in metres."""

    STANDING = "metres; +y is up, the body faces +z and stands on y = 0"
    ON_THE_GROUND = "metres; +y is up, the ground is y = 0"
    UPRIGHT = (
        "metres; +y points against gravity as it was estimated, and the lowest point is at y = 0. "
        "The node 'upright' turns the camera's axes into these: in it the camera stands at the "
        "origin and looks along -z, +x is right and +y up in its picture"
    )
    CAMERA = (
        "metres; the camera's axes: it stands at the origin and looks along -z, +x is right and +y "
        "up in its picture. Which way gravity points is not known"
    )
    CAMERA_TURNED = (
        "metres; +y is up in the picture and +z leads to the camera; the lowest point is at y = 0. "
        "Which way gravity points is not known"
    )


def gltf_document(
    nodes: Sequence[Node],
    model: BodyModel,
    *,
    name: str,
    frame: Frame,
    extras: Mapping[str, object],
) -> dict[str, Any]:
    """A glTF document of one scene that shows all nodes; still without meshes.

    The scene lists the nodes that are no other node's children: what a scene does not reach, no
    viewer shows.

    Parameters
    ----------
    nodes
        All there are.
    model
        Whose provenance.
    name
        Of the scene.
    frame
        The axes the nodes are in.
    extras
        What else is said of the body; JSON values.
    """
    children = {child for node in nodes for child in node.get("children", ())}
    said = {
        "generator": generator_name(),
        "gender": model.gender,
        "frame": frame.value,
        "body_model": {
            "checksum": str(model.header.get("checksum", "")),
            "sources": model.header.get("sources", ""),
            "licences": model.header.get("licences", ""),
        },
        **extras,
    }
    shown = [index for index in range(len(nodes)) if index not in children]
    return {
        # Blender keeps the scene's extras but drops the asset's, so both carry them.
        "asset": {"version": "2.0", "generator": generator_name(), "extras": said},
        "scene": 0,
        "scenes": [{"name": name, "nodes": shown, "extras": said}],
        "nodes": list(nodes),
    }


@cache
def generator_name() -> str:
    """The program and its version as glTF's ``asset.generator`` wants them.

    Once a process: finding the version reads and parses the package's metadata.
    """
    try:
        return f"Maquette {version('maquette')}"
    except PackageNotFoundError:
        return "Maquette (not installed)"
