"""Every rule that a body model's header and fields must satisfy, and the messages for faults.

Nothing here reads files; :mod:`fitter.body.storage` does, and adds the file's name.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Integer

from fitter.numerics.mesh_faults import closed_surface_fault, solid_fault

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
}

LIGHTER_BOUNDS: Mapping[str, tuple[int, str]] = {
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
"""What :mod:`fitter.body.model` measures height by. A fit needs more:
:mod:`fitter.fits.usable_model`."""

SUM_TOLERANCE = 1e-4
"""Of weights that sum to one, kept in single precision."""

BALANCE_TOLERANCE = 1e-4
"""Of a part's right-hand sides, whose sum is zero, relative to the sum of their sizes."""

HEIGHT_RANGE_M = (0.4, 2.6)
"""Vertical extent of a mean body at rest: the smallest child and the tallest person in metres, and
neither in centimetres nor feet."""


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
    yield from _index_faults(arrays, sizes, INDEX_BOUNDS)
    yield from _surface_faults(arrays)
    yield from _part_faults(arrays)
    for kind, key in (("joint", "part_names"), ("landmark", "landmark_names")):
        pointers, weights = arrays[f"{kind}_pointers"], arrays[f"{kind}_weights"]
        yield from _named(f"{kind}_pointers", pointers_fault(pointers, len(weights), shortest=1))
        yield from _named(f"{kind}_weights", means_fault(_texts(header[key]), pointers, weights))
    yield from _named("mirror", involution_fault(arrays["mirror"]))
    yield from _pose_term_faults(arrays)
    for name in ("canonical_pose", "standing_pose"):
        largest = float(np.linalg.norm(arrays[name], axis=1).max())
        if largest > np.pi + SUM_TOLERANCE:
            yield Fault(
                name, f"turns a part by {largest:.4g}, expected rotation vectors of at most π"
            )
    yield from _index_faults(arrays, sizes, LIGHTER_BOUNDS)
    lighter = arrays["lighter_triangles"].astype(np.int32)
    closed = closed_surface_fault(lighter, vertex_count=len(arrays["lighter_kept"]))
    yield from _named("lighter_triangles", closed)
    yield from _named("lighter_shares", shares_fault(arrays["lighter_shares"]))


def _index_faults(
    arrays: Mapping[str, np.ndarray],
    sizes: Mapping[str, int],
    bounds: Mapping[str, tuple[int, str]],
) -> Iterator[Fault]:
    for name, (low, letter) in bounds.items():
        high = 2 * sizes["p"] if letter == "2p" else sizes[letter]
        outside = (arrays[name] < low) | (arrays[name] >= high)
        if outside.any():
            place = _first(outside)
            yield Fault(
                name, f"holds index {arrays[name][place]} at {place}, expected [{low}, {high})"
            )


def pointers_fault(
    pointers: Integer[np.ndarray, " r1"], entries: int, *, shortest: int
) -> str | None:
    """Why pointers do not cut ``entries`` into rows of a minimum length; None if they do."""
    if pointers[0] == 0 and pointers[-1] == entries and (np.diff(pointers) >= shortest).all():
        return None
    return (
        f"runs {pointers[0]} ... {pointers[-1]}, expected to begin at 0, to rise by {shortest} or "
        f"more from row to row and to end at {entries}"
    )


def means_fault(
    names: Sequence[str],
    pointers: Integer[np.ndarray, " r1"],
    weights: Float[np.ndarray, " z"],
) -> str | None:
    """Which row of weights is not a weighted mean; None if all are."""
    sums = np.add.reduceat(weights.astype(np.float64), pointers[:-1])
    worst = int(np.argmax(np.abs(sums - 1.0)))
    if abs(sums[worst] - 1.0) > SUM_TOLERANCE:
        return f"sums to {sums[worst]:.6g} for {names[worst]}, expected 1"
    return None


def involution_fault(mirror: Integer[np.ndarray, " m"]) -> str | None:
    """Why indices within range are not their own inverse; None if they are."""
    astray = np.flatnonzero(mirror[mirror] != np.arange(len(mirror)))
    if len(astray):
        here = int(astray[0])
        there = int(mirror[here])
        return (
            f"is not its own inverse: vertex {here} lies across from {there}, and {there} across "
            f"from {int(mirror[there])}, expected {here}"
        )
    return None


def shares_fault(weights: Float[np.ndarray, "m k"]) -> str | None:
    """Why rows are not shares of a whole; None if they are."""
    if (weights < 0.0).any():
        vertex = int(np.argmax((weights < 0.0).any(axis=1)))
        return f"holds {weights[vertex].min():.4g} at vertex {vertex}, expected no negative weight"
    sums = weights.sum(axis=1, dtype=np.float64)
    worst = int(np.argmax(np.abs(sums - 1.0)))
    if abs(sums[worst] - 1.0) > SUM_TOLERANCE:
        return f"sums to {sums[worst]:.6g} at vertex {worst}, expected 1"
    return None


def _header_faults(header: Mapping[str, object]) -> Iterator[Fault]:
    for key in HEADER_KEYS:
        if key not in header:
            yield Fault(f"header.{key}", "is missing")
    version = header["format_version"]
    if version != FORMAT_VERSION:
        yield Fault("header.format_version", f"is {version!r}, this version reads {FORMAT_VERSION}")
    gender, units, seed = header["gender"], header["units"], header["seed"]
    if gender not in GENDERS:
        yield Fault("header.gender", f"is {gender!r}, expected {' or '.join(GENDERS)}")
    if not isinstance(units, str) or not units.startswith("metres"):
        yield Fault("header.units", f"is {units!r}, expected metres")
    if not isinstance(seed, int) or isinstance(seed, bool):
        yield Fault("header.seed", f"is {seed!r}, expected a whole number")
    for key in ("part_names", "landmark_names", "sources", "licences"):
        names = _texts(header[key])
        if not names:
            yield Fault(
                f"header.{key}", f"is {header[key]!r}, expected a list of names, none empty"
            )
        twice = [name for name in names if names.count(name) > 1]
        if twice and key.endswith("_names"):
            yield Fault(f"header.{key}", f"holds {twice[0]!r} {names.count(twice[0])} times")
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


def _surface_faults(arrays: Mapping[str, np.ndarray]) -> Iterator[Fault]:
    vertices = arrays["mean_vertices"].astype(np.float64)
    triangles = arrays["triangles"].astype(np.int32)
    yield from _named("triangles", closed_surface_fault(triangles, vertex_count=len(vertices)))
    yield from _named("mean_vertices", solid_fault(vertices, triangles))
    low, high = HEIGHT_RANGE_M
    height = float(np.ptp(vertices[:, 1]))
    if not low <= height <= high:
        yield Fault(
            "mean_vertices",
            f"is {height:.4g} high along y, expected {low} to {high}: metres, y up",
        )
    still = ~arrays["shape_basis"].any(axis=(1, 2))
    if still.any():
        yield Fault("shape_basis", f"moves no vertex along axis {np.argmax(still)}")
    weights = arrays["triangle_weights"]
    if (weights <= 0.0).any():
        lowest = int(np.argmin(weights))
        yield Fault(
            "triangle_weights", f"is {weights[lowest]:.4g} at triangle {lowest}, expected > 0"
        )


def _part_faults(arrays: Mapping[str, np.ndarray]) -> Iterator[Fault]:
    parents = arrays["part_parent"]
    if parents[0] != -1:
        yield Fault("part_parent", f"begins with {parents[0]}, expected -1, the root")
    for part, parent in enumerate(parents[1:].tolist(), start=1):
        if not 0 <= parent < part:
            yield Fault(
                "part_parent",
                f"gives part {part} the parent {parent}, expected one of the parts before it",
            )
    pointers, vertices = arrays["incidence_pointers"], arrays["incidence_vertices"]
    yield from _named("incidence_pointers", pointers_fault(pointers, len(vertices), shortest=1))
    for part in range(len(parents)):
        corners = arrays["triangles"][arrays["part_of_triangle"] == part]
        if not len(corners):
            yield Fault("part_of_triangle", f"gives part {part} no triangle")
        listed = np.sort(vertices[pointers[part] : pointers[part + 1]])
        if not np.array_equal(listed, np.unique(corners)):
            yield Fault(
                "incidence_vertices",
                f"does not list the vertices that part {part}'s triangles touch, each once",
            )
    yield from _named("skinning_weights", shares_fault(arrays["skinning_weights"]))


def _pose_term_faults(arrays: Mapping[str, np.ndarray]) -> Iterator[Fault]:
    """A right-hand side Gᵀ W E sums to zero over vertices, as the rows of Gᵀ W G do."""
    terms, starts = arrays["pose_right_hand_sides"], arrays["incidence_pointers"][:-1]
    sums = np.abs(np.add.reduceat(terms, starts, axis=0)).max(axis=(1, 2))
    sizes = np.add.reduceat(np.abs(terms), starts, axis=0).max(axis=(1, 2))
    unbalanced = sums > BALANCE_TOLERANCE * sizes
    if unbalanced.any():
        part = int(np.argmax(unbalanced))
        yield Fault(
            "pose_right_hand_sides",
            f"sums to {sums[part]:.4g} over the vertices of part {part}, expected 0: a body's own "
            "deformation does not push it",
        )


def _first(found: np.ndarray) -> tuple[int, ...]:
    return tuple(int(k) for k in np.argwhere(found)[0])


def _named(field: str, reason: str | None) -> Iterator[Fault]:
    if reason is not None:
        yield Fault(field, reason)
