"""Positions and polygons out of a PLY file: ASCII or binary, whatever else it holds."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from fitter.arrays import Vertices

_TYPES = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_POLYGONS = ("vertex_indices", "vertex_index")


@dataclass(frozen=True, slots=True, kw_only=True)
class _Element:
    """``counters`` are the types of the counts that precede list properties."""

    name: str
    rows: int
    types: dict[str, str] = field(default_factory=dict)
    counters: dict[str, str] = field(default_factory=dict)


def read_ply(path: Path) -> tuple[Vertices, np.ndarray | None]:
    """Vertices (m, 3) and polygons (f, corners); None for polygons that differ in size.

    Raises
    ------
    ValueError, KeyError, IndexError
        If the file is no PLY, or is cut short.
    """
    head, mark, body = path.read_bytes().partition(b"end_header")
    if not head.startswith(b"ply") or not mark:
        message = "it has no PLY header"
        raise ValueError(message)
    body = body.partition(b"\n")[2]
    order, elements = _header(head.decode("utf-8", "replace"))
    lines = body.decode("ascii").splitlines() if order == "" else []
    tables: dict[str, Mapping[str, np.ndarray]] = {}
    for element in elements:
        if element.rows == 0:
            continue
        if order == "":
            tables[element.name] = _text_table(element, lines[: element.rows])
            lines = lines[element.rows :]
        else:
            tables[element.name], body = _binary_table(element, body, order)
        if not tables[element.name]:
            # Rows of differing length: where the next element begins is not known, nor needed.
            break
    vertex = tables["vertex"]
    vertices = np.stack([vertex[axis].astype(np.float64) for axis in "xyz"], axis=1)
    faces = tables.get("face", {})
    polygons = [faces[name].astype(np.int64) for name in _POLYGONS if name in faces]
    return vertices, polygons[0] if polygons else None


def _header(text: str) -> tuple[str, list[_Element]]:
    order, elements = "", []
    for line in text.splitlines():
        kind, *words = line.split() or ("",)
        if kind == "format":
            order = _ORDERS[words[0]]
        elif kind == "element":
            elements.append(_Element(name=words[0], rows=int(words[1])))
        elif kind == "property" and words[0] == "list":
            elements[-1].counters[words[3]] = _TYPES[words[1]]
            elements[-1].types[words[3]] = _TYPES[words[2]]
        elif kind == "property":
            elements[-1].types[words[1]] = _TYPES[words[0]]
    return order, elements


def _text_table(element: _Element, lines: list[str]) -> Mapping[str, np.ndarray]:
    if len(lines) < element.rows:
        message = f"it ends after {len(lines)} of {element.rows} rows of {element.name}"
        raise ValueError(message)
    rows = [line.split() for line in lines]
    if len({len(row) for row in rows}) != 1:
        return {}
    values = np.array(rows, dtype=np.float64)
    columns: dict[str, np.ndarray] = {}
    start = 0
    for name in element.types:
        if name in element.counters:
            length = int(values[0, start])
            columns[name] = values[:, start + 1 : start + 1 + length]
            start += 1 + length
        else:
            columns[name] = values[:, start]
            start += 1
    return columns


def _binary_table(
    element: _Element, body: bytes, order: str
) -> tuple[Mapping[str, np.ndarray], bytes]:
    """The rows as columns, all laid out like the first, and what follows them."""
    fields: list[tuple] = []
    for name, kind in element.types.items():
        if name in element.counters:
            before = np.dtype([*fields, ("count", order + element.counters[name])])
            count = int(np.frombuffer(body, before, count=1)["count"][0])
            fields.append((f"{name} count", order + element.counters[name]))
            fields.append((name, order + kind, (count,)))
        else:
            fields.append((name, order + kind))
    table = np.frombuffer(body, np.dtype(fields), count=element.rows)
    for name in element.counters:
        counts = table[f"{name} count"]
        if (counts != counts[0]).any():
            return {}, b""
    return {name: table[name] for name in element.types}, body[table.nbytes :]
