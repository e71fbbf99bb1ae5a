"""Checks of a file ``person.npz`` before it is used: fields, shapes, values.

The fields are listed in :mod:`fitter.person.fitted_person`. Files are read back from where fits are
kept, so the error for a damaged or foreign one names the field that is wrong.
"""

import io
import json
import zipfile
from collections.abc import Mapping

import numpy as np

from fitter.body.storage import read_arrays
from fitter.errors import InvalidInputError
from fitter.vocabulary.choices import Gender, LightKind

FORMAT_VERSION = 1

MAX_BYTES = 64 * 2**20
"""All arrays together, unpacked: 80 times what a body of 12,440 vertices takes."""

_LARGEST_TURN = 2.0 * np.pi
"""Of a part; a rotation vector longer than a whole turn was never fitted."""

_BODY = {"pose": (-1, 3), "translation": (3,), "shape": (-1,), "camera": (5,)}
_CERTAINTY = {"shape_covariance": (-1, -1)}
_TILT = {"tilt": (2,), "tilt_covariance": (2, 2), "stances": (3,)}
_SHADING = {"light": (3,), "eq_1": (2,), "albedo": (-1,), "specularity": (-1,)}
_COLOUR = {"albedo_rgb": (-1, 3)}


def checked_person(content: bytes) -> tuple[dict[str, object], dict[str, np.ndarray]]:
    """Header and arrays of a file, by name.

    Raises
    ------
    InvalidInputError
        If it is damaged, of another format version, or holds values no fit gives.
    """
    arrays = _unpacked(content)
    header = _header(arrays.pop("header", None))
    _require_fields(arrays, shaded=header["light"] is not None)
    _require_values(arrays)
    return header, arrays


def unusable_person(*, field: str, reason: str) -> InvalidInputError:
    """The error that says what is wrong with a field, or with ``the file``."""
    return InvalidInputError(
        code="person-unusable",
        field=f"person.{field.removeprefix('the ')}",
        reason=f"{field[0].upper()}{field[1:]} {reason}.",
        remedy="Fit the picture again and use the file person.npz of that fit as it is.",
    )


def _unpacked(content: bytes) -> dict[str, np.ndarray]:
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            unpacked = sum(entry.file_size for entry in archive.infolist())
        if unpacked > MAX_BYTES:
            raise unusable_person(
                field="the file", reason=f"unpacks to {unpacked} bytes, more than {MAX_BYTES}"
            )
        return read_arrays(io.BytesIO(content))
    except InvalidInputError:
        raise
    except Exception as error:
        raise unusable_person(
            field="the file", reason=f"is not a readable person ({error})"
        ) from error


def _header(encoded: np.ndarray | None) -> dict[str, object]:
    if encoded is None:
        raise unusable_person(field="header", reason="is missing")
    try:
        header = json.loads(encoded.tobytes())
    except (ValueError, RecursionError) as error:
        raise unusable_person(field="header", reason=f"is no JSON ({error})") from error
    expected: Mapping[str, tuple[object, ...]] = {
        "format_version": (FORMAT_VERSION,),
        "gender": tuple(gender.value for gender in Gender),
        "light": (None, *(kind.value for kind in LightKind)),
    }
    if not isinstance(header, dict):
        raise unusable_person(field="header", reason="is no JSON object")
    for field, values in expected.items():
        if field not in header or header[field] not in values:
            raise unusable_person(
                field=f"header.{field}",
                reason=f"is {header.get(field, 'missing')!r}, expected one of {values}",
            )
    if not isinstance(header.get("model_checksum"), str):
        raise unusable_person(field="header.model_checksum", reason="is missing or no text")
    return header


def _require_fields(arrays: Mapping[str, np.ndarray], *, shaded: bool) -> None:
    tilted = not arrays.keys().isdisjoint(_TILT)
    required = _BODY | (_TILT if tilted else {}) | (_SHADING if shaded else {})
    allowed = required | _CERTAINTY | (_COLOUR if shaded else {})
    for field in required.keys() - arrays.keys():
        raise unusable_person(field=field, reason="is missing")
    for field in arrays.keys() - allowed.keys():
        raise unusable_person(field=field, reason="is no field of a person with this header")
    for field, array in arrays.items():
        pattern = allowed[field]
        fits = array.ndim == len(pattern) and all(
            expected in (-1, found) and found > 0
            for expected, found in zip(pattern, array.shape, strict=True)
        )
        if array.dtype != np.float64 or not fits:
            shape = tuple("any" if size < 0 else size for size in pattern)
            raise unusable_person(
                field=field,
                reason=f"is {array.dtype} of shape {array.shape}, expected float64 of {shape}",
            )
    m = len(arrays["albedo"]) if shaded else 0
    for field in ("specularity", "albedo_rgb"):
        if field in arrays and len(arrays[field]) != m:
            raise unusable_person(
                field=field, reason=f"has {len(arrays[field])} rows, the albedo has {m}"
            )


def _require_covariance(field: str, covariance: np.ndarray, n: int) -> None:
    if covariance.shape != (n, n):
        raise unusable_person(field=field, reason=f"is of shape {covariance.shape}, not ({n}, {n})")
    if not np.allclose(covariance, covariance.T, atol=1e-9):
        raise unusable_person(field=field, reason="is not symmetric")


def _require_values(arrays: Mapping[str, np.ndarray]) -> None:
    for field, array in arrays.items():
        finite = array[:2] if field == "light" else array
        if not np.isfinite(finite).all():
            raise unusable_person(field=field, reason="holds a number that is not finite")
    if "shape_covariance" in arrays:
        _require_covariance("shape_covariance", arrays["shape_covariance"], len(arrays["shape"]))
    if "tilt" in arrays:
        _require_covariance("tilt_covariance", arrays["tilt_covariance"], 2)
        if arrays["tilt_covariance"].diagonal().min() < 0.0:
            raise unusable_person(field="tilt_covariance", reason="has a negative variance")
        if arrays["stances"].min() < 0.0 or not np.isclose(arrays["stances"].sum(), 1.0):
            raise unusable_person(field="stances", reason="are no probabilities")
    if np.linalg.norm(arrays["pose"], axis=1).max() > _LARGEST_TURN:
        raise unusable_person(field="pose", reason="turns a part by more than a whole turn")
    if arrays["translation"][2] <= 0.0:
        raise unusable_person(field="translation", reason="puts the body behind the camera")
    focal_length, _, _, width, height = arrays["camera"]
    if focal_length <= 0.0 or min(width, height) < 1.0 or width % 1.0 or height % 1.0:
        raise unusable_person(
            field="camera",
            reason="needs a positive focal length and a picture of whole pixels, one at least",
        )
    if "albedo" not in arrays:
        return
    for field in ("albedo", "specularity", "albedo_rgb"):
        if field in arrays and arrays[field].min() < 0.0:
            raise unusable_person(field=field, reason="is negative somewhere")
    ambient, exponent = arrays["eq_1"]
    if ambient < 0.0 or exponent < 1.0:
        raise unusable_person(
            field="eq_1", reason="needs an ambient term of 0 and an exponent of 1 at least"
        )
