"""A reader of GLB files that shares no code with the writer."""

import json
import struct
from dataclasses import dataclass

import numpy as np

DTYPES = {5126: np.dtype("<f4"), 5123: np.dtype("<u2"), 5125: np.dtype("<u4")}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


@dataclass(frozen=True)
class Glb:
    document: dict
    binary: bytes

    def accessor(self, index: int) -> np.ndarray:
        accessor = self.document["accessors"][index]
        view = self.document["bufferViews"][accessor["bufferView"]]
        width = WIDTHS[accessor["type"]]
        values = np.frombuffer(
            self.binary,
            dtype=DTYPES[accessor["componentType"]],
            count=accessor["count"] * width,
            offset=view["byteOffset"],
        )
        return values.reshape(-1, width) if width > 1 else values

    @property
    def attributes(self) -> dict[str, int]:
        return self.document["meshes"][0]["primitives"][0]["attributes"]

    def attribute(self, name: str) -> np.ndarray:
        return self.accessor(self.attributes[name])


def read_glb(content: bytes) -> Glb:
    magic, version, length = struct.unpack_from("<4sII", content, 0)
    assert (magic, version, length) == (b"glTF", 2, len(content))
    text_length, kind = struct.unpack_from("<I4s", content, 12)
    assert kind == b"JSON"
    start = 20 + text_length
    binary_length, kind = struct.unpack_from("<I4s", content, start)
    assert kind == b"BIN\0"
    assert start + 8 + binary_length == length
    return Glb(json.loads(content[20:start]), content[start + 8 :])
