"""Read and write body model files: one ``.npz`` a gender, checked field by field."""

import hashlib
import json
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from fitter.body.model import BodyModel, SparseRows
from fitter.errors import ModelFileError

FORMAT_VERSION = 1

REBUILD = "Rebuild it with `python -m fitter.training` or reinstall the package."

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
    "canonical_pose": ("f", ("p", 3)),
    "standing_pose": ("f", ("p", 3)),
}

# What numpy raises on a missing header, a cut, emptied, damaged or pickled file, or a bare .npy.
_UNREADABLE = (OSError, EOFError, ValueError, KeyError, TypeError, zipfile.BadZipFile, zlib.error)

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


def arrays_checksum(arrays: Mapping[str, np.ndarray]) -> str:
    """SHA-256 over all fields' names, types, shapes and bytes, in field order."""
    digest = hashlib.sha256()
    for name in FIELDS:
        array = np.ascontiguousarray(arrays[name])
        digest.update(f"{name}:{array.dtype.str}:{array.shape}".encode())
        digest.update(array.tobytes())
    return digest.hexdigest()


def save_body_model(
    path: Path, *, header: Mapping[str, object], arrays: Mapping[str, np.ndarray]
) -> None:
    """Write a model file; the checksum is added to the header. The same input gives the same bytes.

    Raises
    ------
    ModelFileError
        If a field is missing or has the wrong type or shape.
    """
    full_header = dict(header) | {
        "format_version": FORMAT_VERSION,
        "checksum": "",
    }
    _check_fields(path.name, full_header, arrays)
    full_header["checksum"] = arrays_checksum(arrays)
    encoded = np.frombuffer(json.dumps(full_header, sort_keys=True).encode(), dtype=np.uint8)
    members: dict[str, np.ndarray] = {"header": encoded}
    members |= {name: np.ascontiguousarray(arrays[name]) for name in FIELDS}
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, array in members.items():
            # A fixed date: np.savez stamps the present one, and the bytes would never repeat.
            entry = zipfile.ZipInfo(f"{name}.npy", date_time=(1980, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            with archive.open(entry, "w") as stream:
                np.lib.format.write_array(stream, array, allow_pickle=False)


def load_body_model(path: Path) -> BodyModel:
    """Read and check a model file.

    Raises
    ------
    ModelFileError
        If the file is missing, damaged, of another format version, or a field is wrong.
    """
    if not path.exists():
        message = f"No body model at {path.name}. {REBUILD}"
        raise ModelFileError(message)
    try:
        # numpy leaves the file open when it finds no archive in it, so it is opened here.
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as archive:
            members = {name: archive[name] for name in archive.files}
        header = json.loads(members["header"].tobytes())
    except _UNREADABLE as error:
        message = f"{path.name} is not a readable body model ({error}). {REBUILD}"
        raise ModelFileError(message) from error
    _check_fields(path.name, header, members)
    if header["format_version"] != FORMAT_VERSION:
        message = (
            f"{path.name}: header.format_version is {header['format_version']}, this version "
            f"reads {FORMAT_VERSION}. {REBUILD}"
        )
        raise ModelFileError(message)
    if header["checksum"] != arrays_checksum(members):
        message = f"{path.name}: the checksum does not match; the file is damaged. {REBUILD}"
        raise ModelFileError(message)
    return _assemble(header, members)


def packaged_model_path(gender: str) -> Path:
    """Path of the model file shipped with the package for ``female`` or ``male``."""
    return Path(__file__).parent / "data" / f"{gender}.npz"


def _assemble(header: Mapping[str, object], members: Mapping[str, np.ndarray]) -> BodyModel:
    def floats(name: str) -> np.ndarray:
        return members[name].astype(np.float64)

    part_names = tuple(str(name) for name in header["part_names"])  # pyright: ignore
    landmark_names = tuple(str(name) for name in header["landmark_names"])  # pyright: ignore
    return BodyModel(
        gender=str(header["gender"]),
        header=header,
        triangles=members["triangles"].astype(np.int32),
        mean_vertices=floats("mean_vertices"),
        shape_basis=floats("shape_basis"),
        part_names=part_names,
        part_parent=members["part_parent"].astype(np.int32),
        part_of_triangle=members["part_of_triangle"].astype(np.int32),
        triangle_weights=floats("triangle_weights"),
        joint_regressor=SparseRows(
            names=part_names,
            pointers=members["joint_pointers"],
            indices=members["joint_indices"],
            weights=floats("joint_weights"),
        ),
        skinning_parts=members["skinning_parts"].astype(np.int32),
        skinning_weights=floats("skinning_weights"),
        pose_feature_joints=members["pose_feature_joints"].astype(np.int32),
        pose_feature_strengths=floats("pose_feature_strengths"),
        incidence_pointers=members["incidence_pointers"].astype(np.int32),
        incidence_vertices=members["incidence_vertices"].astype(np.int32),
        pose_right_hand_sides=members["pose_right_hand_sides"],
        landmarks=SparseRows(
            names=landmark_names,
            pointers=members["landmark_pointers"],
            indices=members["landmark_indices"],
            weights=floats("landmark_weights"),
        ),
        uv=floats("uv"),
        uv_triangles=members["uv_triangles"].astype(np.int32),
        mirror=members["mirror"].astype(np.int32),
        canonical_pose=floats("canonical_pose"),
        standing_pose=floats("standing_pose"),
    )


def _check_fields(
    file_name: str, header: Mapping[str, object], arrays: Mapping[str, np.ndarray]
) -> None:
    for key in HEADER_KEYS:
        if key not in header:
            message = f"{file_name}: header.{key} is missing. {REBUILD}"
            raise ModelFileError(message)
    sizes: dict[str, int] = {
        "p": len(header["part_names"]),  # pyright: ignore
        "l": len(header["landmark_names"]),  # pyright: ignore
    }
    for name, (kind, shape) in FIELDS.items():
        if name not in arrays:
            message = f"{file_name}: field {name} is missing. {REBUILD}"
            raise ModelFileError(message)
        array = arrays[name]
        expected_kind = "iu" if kind == "i" else "f"
        if array.dtype.kind not in expected_kind:
            message = f"{file_name}: field {name} has type {array.dtype}, not {kind}. {REBUILD}"
            raise ModelFileError(message)
        if array.ndim != len(shape) or not all(
            _dimension_fits(letter, size, sizes)
            for letter, size in zip(shape, array.shape, strict=True)
        ):
            message = (
                f"{file_name}: field {name} has shape {array.shape}, expected {shape} with "
                f"{sizes}. {REBUILD}"
            )
            raise ModelFileError(message)
        if array.dtype.kind == "f" and not np.isfinite(array).all():
            message = f"{file_name}: field {name} holds a number that is not finite. {REBUILD}"
            raise ModelFileError(message)
    _check_indices(file_name, sizes, arrays)


def _dimension_fits(letter: str | int, size: int, sizes: dict[str, int]) -> bool:
    if isinstance(letter, int):
        return size == letter
    if letter.endswith("+1"):
        return size == sizes.setdefault(letter[:-2], size - 1) + 1
    if letter.startswith("9"):
        return size == 9 * sizes[letter[1:]]
    return size == sizes.setdefault(letter, size)


def _check_indices(
    file_name: str, sizes: Mapping[str, int], arrays: Mapping[str, np.ndarray]
) -> None:
    bounds = {
        "triangles": (0, sizes["m"]),
        "part_of_triangle": (0, sizes["p"]),
        "part_parent": (-1, sizes["p"]),
        "joint_indices": (0, sizes["m"]),
        "skinning_parts": (0, sizes["p"]),
        "pose_feature_joints": (-1, sizes["p"]),
        "incidence_vertices": (0, sizes["m"]),
        "landmark_indices": (0, sizes["m"]),
        "uv_triangles": (0, sizes["u"]),
        "mirror": (0, sizes["m"]),
    }
    for name, (low, high) in bounds.items():
        array = arrays[name]
        if array.size and (int(array.min()) < low or int(array.max()) >= high):
            message = f"{file_name}: field {name} holds an index outside [{low}, {high}). {REBUILD}"
            raise ModelFileError(message)
