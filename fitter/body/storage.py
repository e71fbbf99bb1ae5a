"""Read and write body model files: one ``.npz`` per gender, checked field by field."""

import hashlib
import io
import json
import zipfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from fitter.body.model import BodyModel, LighterMesh, SparseRows
from fitter.body.model_checks import FIELDS, FORMAT_VERSION, model_faults
from fitter.errors import ModelFileError


def write_arrays(
    target: Path | io.BytesIO, arrays: Mapping[str, np.ndarray], *, compression: int
) -> None:
    """Write the arrays under their names, in their order, ``ZIP_STORED`` or ``ZIP_DEFLATED``."""
    with zipfile.ZipFile(target, "w") as archive:
        for name, array in arrays.items():
            # A fixed date: np.savez stamps the present one, and the bytes would never repeat.
            entry = zipfile.ZipInfo(f"{name}.npy", date_time=(1980, 1, 1, 0, 0, 0))
            entry.compress_type = compression
            with archive.open(entry, "w") as stream:
                np.lib.format.write_array(stream, array, allow_pickle=False)


def read_arrays(source: io.BytesIO | io.BufferedReader) -> dict[str, np.ndarray]:
    """Every array of the file by name.

    What numpy and zipfile raise on a cut, emptied, damaged or pickled file, or on a bare ``.npy``,
    is nowhere promised: a caller who reads what may be damaged catches ``Exception``.
    """
    with np.load(source, allow_pickle=False) as archive:
        return {name: archive[name] for name in archive.files}


REMAKE = (
    "Make the file again: `python -m fitter.training` for the packaged models, or "
    "`python -m fitter.training --meshes FOLDER` for your own (OWN_BODIES.md)."
)

_HEADER = "header"


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
        If the file could not be loaded again; then none is written.
    """
    full_header = dict(header) | {"format_version": FORMAT_VERSION, "checksum": ""}
    _check(path, full_header, arrays)
    full_header["checksum"] = arrays_checksum(arrays)
    encoded = np.frombuffer(json.dumps(full_header, sort_keys=True).encode(), dtype=np.uint8)
    members: dict[str, np.ndarray] = {_HEADER: encoded}
    members |= {name: np.ascontiguousarray(arrays[name]) for name in FIELDS}
    write_arrays(path, members, compression=zipfile.ZIP_DEFLATED)


def load_body_model(path: Path, *, gender: str | None = None) -> BodyModel:
    """Read and check a model file.

    Parameters
    ----------
    path
        The file.
    gender
        The gender it must be a model of; None takes either.

    Raises
    ------
    ModelFileError
        If the file is missing, damaged, of another format version or gender, or breaks a rule of
        :mod:`fitter.body.model_checks`.
    """
    members = _read(path)
    header = _decoded_header(path, members.pop(_HEADER, None))
    _check(path, header, members)
    if header["checksum"] != arrays_checksum(members):
        raise ModelFileError(
            file=path.name,
            field="header.checksum",
            reason="is not that of the fields: the file was damaged, or changed by hand",
            remedy=f"Copy it again from where it came from. {REMAKE}",
        )
    if gender not in (None, header["gender"]):
        raise ModelFileError(
            file=path.name,
            field="header.gender",
            reason=f"is {header['gender']}, expected {gender}",
            remedy="A folder of models holds female.npz and male.npz; give each file its name.",
        )
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
        lighter=LighterMesh(
            kept=members["lighter_kept"].astype(np.int64),
            triangles=members["lighter_triangles"].astype(np.int32),
            origin=members["lighter_origin"].astype(np.int64),
            corners=members["lighter_corners"].astype(np.int32),
            shares=floats("lighter_shares"),
        ),
        canonical_pose=floats("canonical_pose"),
        standing_pose=floats("standing_pose"),
    )


def _read(path: Path) -> dict[str, np.ndarray]:
    if not path.is_file():
        raise ModelFileError(
            file=path.name,
            field="the file",
            reason=f"is not in {path.parent}",
            remedy=REMAKE,
        )
    try:
        # numpy leaves the file open when it finds no archive in it, so it is opened here.
        with path.open("rb") as stream:
            return read_arrays(stream)
    except Exception as error:
        raise _unreadable(path, error) from error


def _decoded_header(path: Path, encoded: np.ndarray | None) -> dict[str, object]:
    if encoded is None:
        raise _unreadable(path, "it has no header")
    try:
        header = json.loads(encoded.tobytes())
    except (ValueError, RecursionError) as error:
        raise _unreadable(path, f"its header is no JSON: {error}") from error
    if not isinstance(header, dict):
        raise _unreadable(path, "its header is no JSON object")
    return header


def _unreadable(path: Path, why: object) -> ModelFileError:
    return ModelFileError(
        file=path.name,
        field="the file",
        reason=f"is not a readable body model ({why})",
        remedy=f"Copy it again from where it came from. {REMAKE}",
    )


def _check(path: Path, header: Mapping[str, object], arrays: Mapping[str, np.ndarray]) -> None:
    for fault in model_faults(header, arrays):
        raise ModelFileError(file=path.name, field=fault.field, reason=fault.reason, remedy=REMAKE)
