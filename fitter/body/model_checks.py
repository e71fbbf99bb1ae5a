"""Rules of a body model's header and fields, without which reading or evaluating it would fail.

That it is a body is seen to where it is made (:mod:`fitter.training`), and a checksum tells whether
a file is what was written. Nothing here reads files; :mod:`fitter.body.storage` does, and adds the
file's name.
"""

from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np
from jaxtyping import Integer

FORMAT_VERSION = 2

GENDERS = ("female", "male")

# Field -> (kind, shape); letters are dimensions that must agree across fields.
FIELDS: Mapping[str, tuple[str, tuple[str | int, ...]]] = {
    "triangles": ("i", ("f", 3)),
    "mean_vertices": ("f", ("m", 3)),
    "shape_basis": ("f", ("n", "m", 3)),
    "part_parent": ("i", ("p",)),
    "part_of_triangle": ("i", ("f",)),
    "triangle_weights": ("f", ("f",)),
    "joint_pointers": ("i", ("p+1",)),
    "joint_indices": ("i", ("zj",)),
    "joint_weights": ("f", ("zj",)),
    "skinning_parts": ("i", ("m", 4)),
    "skinning_weights": ("f", ("m", 4)),
    "pose_feature_joints": ("i", ("p", "q")),
    "pose_feature_strengths": ("f", ("p", "9q", "n")),
    "incidence_pointers": ("i", ("p+1",)),
    "incidence_vertices": ("i", ("i",)),
    "pose_right_hand_sides": ("f", ("i", 3, "9q")),
    "landmark_pointers": ("i", ("l+1",)),
    "landmark_indices": ("i", ("zl",)),
    "landmark_weights": ("f", ("zl",)),
    "uv": ("f", ("u", 2)),
    "uv_triangles": ("i", ("f", 3)),
    "mirror": ("i", ("m",)),
    "lighter_kept": ("i", ("k",)),
    "lighter_triangles": ("i", ("g", 3)),
    "lighter_origin": ("i", ("g",)),
    "lighter_corners": ("i", ("m", 3)),
    "lighter_shares": ("f", ("m", 3)),
    "canonical_pose": ("f", ("p", 3)),
    "standing_pose": ("f", ("p", 3)),
}

# Field -> (lowest index, dimension it must stay below).
INDEX_BOUNDS: Mapping[str, tuple[int, str]] = {
    "triangles": (0, "m"),
    "part_of_triangle": (0, "p"),
    "part_parent": (-1, "p"),
    "joint_indices": (0, "m"),
    "skinning_parts": (0, "p"),
    "pose_feature_joints": (-1, "2p"),
    "incidence_vertices": (0, "m"),
    "landmark_indices": (0, "m"),
    "uv_triangles": (0, "u"),
    "mirror": (0, "m"),
    "lighter_kept": (0, "m"),
    "lighter_triangles": (0, "k"),
    "lighter_origin": (0, "f"),
    "lighter_corners": (0, "k"),
}

HEADER_KEYS = (
    "format_version",
    "gender",
    "units",
    "part_names",
    "landmark_names",
    "sources",
    "licences",
    "seed",
    "checksum",
)

STATURE_LANDMARKS = ("crown", "sole_left", "sole_right")
"""Landmarks by which :mod:`fitter.body.model` measures height. A fit needs more:
:mod:`fitter.fits.usable_model`."""


class Fault(NamedTuple):
    """A rule that is broken: the field, and what was found where what was expected."""

    field: str
    reason: str


def model_faults(header: Mapping[str, object], arrays: Mapping[str, np.ndarray]) -> Iterator[Fault]:
    """Everything wrong with a model but the checksum; none if it can be used.

    Take the first: each rule presupposes those before it, so what comes after a fault may raise.
    """
    yield from _header_faults(header)
    sizes: dict[str, int] = {
        "p": len(_texts(header["part_names"])),
        "l": len(_texts(header["landmark_names"])),
    }
    yield from _field_faults(arrays, sizes)
    yield from _index_faults(arrays, sizes)
    for kind, entries in (
        ("joint", "joint_weights"),
        ("landmark", "landmark_weights"),
        ("incidence", "incidence_vertices"),
    ):
        name = f"{kind}_pointers"
        reason = pointers_fault(arrays[name], len(arrays[entries]))
        if reason is not None:
            yield Fault(name, reason)


def _index_faults(arrays: Mapping[str, np.ndarray], sizes: Mapping[str, int]) -> Iterator[Fault]:
    for name, (low, letter) in INDEX_BOUNDS.items():
        high = 2 * sizes["p"] if letter == "2p" else sizes[letter]
        outside = (arrays[name] < low) | (arrays[name] >= high)
        if outside.any():
            place = _first(outside)
            yield Fault(
                name, f"holds index {arrays[name][place]} at {place}, expected [{low}, {high})"
            )


def pointers_fault(pointers: Integer[np.ndarray, " r1"], entries: int) -> str | None:
    """Why pointers do not cut ``entries`` into rows, none empty; None if they do."""
    if pointers[0] == 0 and pointers[-1] == entries and (np.diff(pointers) >= 1).all():
        return None
    return (
        f"runs {pointers[0]} ... {pointers[-1]}, expected to begin at 0, to rise from row to row "
        f"and to end at {entries}"
    )


def _header_faults(header: Mapping[str, object]) -> Iterator[Fault]:
    for key in HEADER_KEYS:
        if key not in header:
            yield Fault(f"header.{key}", "is missing")
    version = header["format_version"]
    if version != FORMAT_VERSION:
        yield Fault("header.format_version", f"is {version!r}, this version reads {FORMAT_VERSION}")
    if header["gender"] not in GENDERS:
        yield Fault("header.gender", f"is {header['gender']!r}, expected {' or '.join(GENDERS)}")
    for key in ("part_names", "landmark_names"):
        if not _texts(header[key]):
            yield Fault(
                f"header.{key}", f"is {header[key]!r}, expected a list of names, none empty"
            )
    for name in STATURE_LANDMARKS:
        if name not in _texts(header["landmark_names"]):
            yield Fault("header.landmark_names", f"lacks {name}, which stature is measured by")


def _texts(value: object) -> list[str]:
    """A list of texts, none of them empty; an empty list where the value is anything else."""
    if isinstance(value, list) and all(isinstance(text, str) and text.strip() for text in value):
        return value
    return []


def _field_faults(arrays: Mapping[str, np.ndarray], sizes: dict[str, int]) -> Iterator[Fault]:
    """Faults of names, types, shapes and values that are not finite; fills in ``sizes``."""
    for name in arrays:
        if name not in FIELDS:
            yield Fault(name, f"is no field of a body model; these are: {', '.join(FIELDS)}")
    for name, (kind, shape) in FIELDS.items():
        if name not in arrays:
            yield Fault(name, "is missing")
        array = arrays[name]
        if array.dtype.kind not in ("iu" if kind == "i" else "f"):
            wanted = "whole numbers" if kind == "i" else "floating point"
            yield Fault(name, f"has type {array.dtype}, expected {wanted}")
        if array.ndim != len(shape) or not all(
            _dimension_fits(letter, size, sizes)
            for letter, size in zip(shape, array.shape, strict=True)
        ):
            wanted = ", ".join(map(str, shape))
            known = ", ".join(f"{letter} = {size}" for letter, size in sizes.items())
            yield Fault(name, f"has shape {array.shape}, expected ({wanted}) with {known}")
        if array.size == 0:
            yield Fault(name, f"is empty, its shape {array.shape}")
        if kind == "f" and not np.isfinite(array).all():
            place = _first(~np.isfinite(array))
            yield Fault(name, f"holds {array[place]} at {place}, expected finite numbers")


def _dimension_fits(letter: str | int, size: int, sizes: dict[str, int]) -> bool:
    if isinstance(letter, int):
        return size == letter
    if letter.endswith("+1"):
        return size == sizes.setdefault(letter[:-2], size - 1) + 1
    if letter.startswith("9"):
        return size == 9 * sizes[letter[1:]]
    return size == sizes.setdefault(letter, size)


def _first(found: np.ndarray) -> tuple[int, ...]:
    return tuple(int(k) for k in np.argwhere(found)[0])
