"""What a finished fit knows that its applications need, in full precision, as one small file.

``person.npz`` holds a JSON header and arrays in double precision, without pickle. Its fields:

====================  ==========  ==================================================================
``header``            bytes       format version, gender, checksum of the body model, kind of light
``pose``              (p, 3)      as in :class:`~fitter.parameters.BodyParameters`
``translation``       (3,)        root joint, camera frame, metres
``shape``             (n,)        standard deviations
``shape_covariance``  (n, n)      of ``shape``; where it is known
``camera``            (5,)        focal length, principal point (x, y), width, height; pixels
``light``             (3,)        azimuth, elevation (radians), distance (metres, infinite for a
                                  directional light); SES only, as all that follows
``eq_1``              (2,)        ambient, specular exponent
``albedo``            (m,)        of luminance
``specularity``       (m,)
``albedo_rgb``        (m, 3)      where colour was estimated
====================  ==========  ==================================================================
"""

import io
import json
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.array_archive import read_arrays, write_arrays
from fitter.arrays import Vertices
from fitter.body.model import BodyModel
from fitter.camera import Camera
from fitter.errors import InvalidInputError
from fitter.parameters import BodyParameters, Light, LightKind, Reflectance
from fitter.request import Gender
from fitter.result import FitResult

FORMAT_VERSION = 1

MAX_BYTES = 64 * 2**20
"""Of all arrays together, unpacked: 80 times what a body of 12,440 vertices takes."""

_LARGEST_TURN = 2.0 * np.pi
"""Of a part; a rotation vector longer than a whole turn was never fitted."""

_BODY = {"pose": (-1, 3), "translation": (3,), "shape": (-1,), "camera": (5,)}
_CERTAINTY = {"shape_covariance": (-1, -1)}
_SHADING = {"light": (3,), "eq_1": (2,), "albedo": (-1,), "specularity": (-1,)}
_COLOUR = {"albedo_rgb": (-1, 3)}


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FittedPerson:
    """A fitted body with its camera, light and reflectance.

    Attributes
    ----------
    gender, model_checksum
        The body model it was fitted with; see :func:`require_model`.
    body
        Shape, pose and position in the camera frame.
    camera
        Of the upright original picture, whose size it carries.
    light, reflectance
        Θ_L and Θ_R of section 5; both None after a fit by silhouettes and edges alone.
    albedo_rgb
        (m, 3) linear red, green and blue albedo; None where no colour was estimated.
    shape_covariance
        (n, n) of the shape's coefficients; None for a body whose certainty is not known.
    """

    gender: Gender
    model_checksum: str
    body: BodyParameters
    camera: Camera
    light: Light | None
    reflectance: Reflectance | None
    albedo_rgb: Vertices | None
    shape_covariance: Float[np.ndarray, "n n"] | None = None

    def to_bytes(self) -> bytes:
        """The file; the same person gives the same bytes."""
        camera, light, reflectance = self.camera, self.light, self.reflectance
        header = {
            "format_version": FORMAT_VERSION,
            "gender": self.gender.value,
            "model_checksum": self.model_checksum,
            "light": None if light is None else light.kind.value,
        }
        arrays = {
            "header": np.frombuffer(json.dumps(header, sort_keys=True).encode(), dtype=np.uint8),
            "pose": self.body.pose,
            "translation": self.body.translation,
            "shape": self.body.shape,
            "camera": np.array(
                [
                    camera.focal_length_px,
                    *(camera.centre_x, camera.centre_y),
                    *(camera.width, camera.height),
                ],
                dtype=np.float64,
            ),
        }
        if self.shape_covariance is not None:
            arrays["shape_covariance"] = self.shape_covariance
        if light is not None and reflectance is not None:
            arrays |= {
                "light": np.array([light.azimuth, light.elevation, light.distance]),
                "eq_1": np.array([reflectance.ambient, reflectance.specular_exponent]),
                "albedo": reflectance.albedo,
                "specularity": reflectance.specularity,
            }
            if self.albedo_rgb is not None:
                arrays["albedo_rgb"] = self.albedo_rgb
        stream = io.BytesIO()
        write_arrays(
            stream,
            {
                name: array if name == "header" else np.ascontiguousarray(array, dtype="<f8")
                for name, array in arrays.items()
            },
            # Deflated, 12,440 vertices take 452 kB instead of 501, and 16 ms instead of 1.
            compression=zipfile.ZIP_STORED,
        )
        return stream.getvalue()

    @classmethod
    def from_bytes(cls, content: bytes) -> "FittedPerson":
        """Read and check the file.

        Raises
        ------
        InvalidInputError
            If it is damaged, of another format version, or holds values no fit gives.
        """
        arrays = _unpacked(content)
        header = _header(arrays.pop("header", None))
        _require_fields(arrays, shaded=header["light"] is not None)
        _require_values(arrays)
        focal_length, centre_x, centre_y, width, height = arrays["camera"].tolist()
        return cls(
            gender=Gender(str(header["gender"])),
            model_checksum=str(header["model_checksum"]),
            body=BodyParameters(
                pose=arrays["pose"], translation=arrays["translation"], shape=arrays["shape"]
            ),
            camera=Camera(
                focal_length_px=focal_length,
                centre_x=centre_x,
                centre_y=centre_y,
                width=int(width),
                height=int(height),
            ),
            light=_light(header["light"], arrays),
            reflectance=_reflectance(arrays) if header["light"] is not None else None,
            albedo_rgb=arrays.get("albedo_rgb"),
            shape_covariance=arrays.get("shape_covariance"),
        )


def fitted_person(result: FitResult, model: BodyModel) -> FittedPerson:
    """What the applications need of a fit's result.

    Parameters
    ----------
    result
        Of the fit.
    model
        The body model it was fitted with.
    """
    shaded = result.light is not None and result.reflectance is not None
    return FittedPerson(
        gender=result.gender,
        model_checksum=str(model.header.get("checksum", "")),
        body=result.body,
        camera=result.image_camera,
        light=result.light if shaded else None,
        reflectance=result.reflectance if shaded else None,
        albedo_rgb=result.albedo_rgb if shaded else None,
        shape_covariance=result.shape_covariance,
    )


def require_model(person: FittedPerson, model: BodyModel) -> None:
    """Check that a body model is the one the person was fitted with.

    Raises
    ------
    InvalidInputError
        If it is another: coefficients and vertices would mean something else.
    """
    if person.gender.value != model.gender:
        raise _unusable(
            field="gender", reason=f"is {person.gender.value}, the body model's is {model.gender}"
        )
    if person.model_checksum != str(model.header.get("checksum", "")):
        raise _unusable(
            field="model_checksum", reason="is that of another body model than the service has now"
        )
    m, n, p = len(model.mean_vertices), len(model.shape_basis), len(model.part_names)
    counts = {"pose": (len(person.body.pose), p), "shape": (len(person.body.shape), n)}
    if person.reflectance is not None:
        counts["albedo"] = (len(person.reflectance.albedo), m)
    for field, (found, expected) in counts.items():
        if found != expected:
            raise _unusable(
                field=field, reason=f"has {found} rows, the body model wants {expected}"
            )


def _unpacked(content: bytes) -> dict[str, np.ndarray]:
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            unpacked = sum(entry.file_size for entry in archive.infolist())
        if unpacked > MAX_BYTES:
            raise _unusable(
                field="the file", reason=f"unpacks to {unpacked} bytes, more than {MAX_BYTES}"
            )
        return read_arrays(io.BytesIO(content))
    except InvalidInputError:
        raise
    except Exception as error:
        raise _unusable(field="the file", reason=f"is not a readable person ({error})") from error


def _header(encoded: np.ndarray | None) -> dict[str, object]:
    if encoded is None:
        raise _unusable(field="header", reason="is missing")
    try:
        header = json.loads(encoded.tobytes())
    except (ValueError, RecursionError) as error:
        raise _unusable(field="header", reason=f"is no JSON ({error})") from error
    expected: Mapping[str, tuple[object, ...]] = {
        "format_version": (FORMAT_VERSION,),
        "gender": tuple(gender.value for gender in Gender),
        "light": (None, *(kind.value for kind in LightKind)),
    }
    if not isinstance(header, dict):
        raise _unusable(field="header", reason="is no JSON object")
    for field, values in expected.items():
        if field not in header or header[field] not in values:
            raise _unusable(
                field=f"header.{field}",
                reason=f"is {header.get(field, 'missing')!r}, expected one of {values}",
            )
    if not isinstance(header.get("model_checksum"), str):
        raise _unusable(field="header.model_checksum", reason="is missing or no text")
    return header


def _require_fields(arrays: Mapping[str, np.ndarray], *, shaded: bool) -> None:
    required = _BODY | (_SHADING if shaded else {})
    allowed = required | _CERTAINTY | (_COLOUR if shaded else {})
    for field in required.keys() - arrays.keys():
        raise _unusable(field=field, reason="is missing")
    for field in arrays.keys() - allowed.keys():
        raise _unusable(field=field, reason="is no field of a person with this header")
    for field, array in arrays.items():
        pattern = allowed[field]
        fits = array.ndim == len(pattern) and all(
            expected in (-1, found) and found > 0
            for expected, found in zip(pattern, array.shape, strict=True)
        )
        if array.dtype != np.float64 or not fits:
            shape = tuple("any" if size < 0 else size for size in pattern)
            raise _unusable(
                field=field,
                reason=f"is {array.dtype} of shape {array.shape}, expected float64 of {shape}",
            )
    m = len(arrays["albedo"]) if shaded else 0
    for field in ("specularity", "albedo_rgb"):
        if field in arrays and len(arrays[field]) != m:
            raise _unusable(
                field=field, reason=f"has {len(arrays[field])} rows, the albedo has {m}"
            )


def _require_covariance(covariance: np.ndarray, n: int) -> None:
    if covariance.shape != (n, n):
        raise _unusable(
            field="shape_covariance", reason=f"is of shape {covariance.shape}, not ({n}, {n})"
        )
    if not np.allclose(covariance, covariance.T, atol=1e-9):
        raise _unusable(field="shape_covariance", reason="is not symmetric")


def _require_values(arrays: Mapping[str, np.ndarray]) -> None:
    for field, array in arrays.items():
        finite = array[:2] if field == "light" else array
        if not np.isfinite(finite).all():
            raise _unusable(field=field, reason="holds a number that is not finite")
    if "shape_covariance" in arrays:
        _require_covariance(arrays["shape_covariance"], len(arrays["shape"]))
    if np.linalg.norm(arrays["pose"], axis=1).max() > _LARGEST_TURN:
        raise _unusable(field="pose", reason="turns a part by more than a whole turn")
    if arrays["translation"][2] <= 0.0:
        raise _unusable(field="translation", reason="puts the body behind the camera")
    focal_length, _, _, width, height = arrays["camera"]
    if focal_length <= 0.0 or min(width, height) < 1.0 or width % 1.0 or height % 1.0:
        raise _unusable(
            field="camera",
            reason="needs a positive focal length and a picture of whole pixels, one at least",
        )
    if "albedo" not in arrays:
        return
    for field in ("albedo", "specularity", "albedo_rgb"):
        if field in arrays and arrays[field].min() < 0.0:
            raise _unusable(field=field, reason="is negative somewhere")
    ambient, exponent = arrays["eq_1"]
    if ambient < 0.0 or exponent < 1.0:
        raise _unusable(
            field="eq_1", reason="needs an ambient term of 0 and an exponent of 1 at least"
        )


def _light(kind: object, arrays: Mapping[str, np.ndarray]) -> Light | None:
    if kind is None:
        return None
    azimuth, elevation, distance = arrays["light"].tolist()
    light = Light(
        kind=LightKind(str(kind)), azimuth=azimuth, elevation=elevation, distance=distance
    )
    infinite = light.kind is LightKind.DIRECTIONAL
    if not distance > 0.0 or np.isinf(distance) != infinite:
        wanted = "infinite" if infinite else "positive and finite"
        raise _unusable(
            field="light", reason=f"is {distance} m away, expected {wanted} for a {kind} light"
        )
    return light


def _reflectance(arrays: Mapping[str, np.ndarray]) -> Reflectance:
    ambient, exponent = arrays["eq_1"].tolist()
    return Reflectance(
        albedo=arrays["albedo"],
        specularity=arrays["specularity"],
        ambient=ambient,
        specular_exponent=exponent,
    )


def _unusable(*, field: str, reason: str) -> InvalidInputError:
    return InvalidInputError(
        code="person-unusable",
        field=f"person.{field.removeprefix('the ')}",
        reason=f"{field[0].upper()}{field[1:]} {reason}.",
        remedy="Fit the picture again and use the file person.npz of that fit as it is.",
    )
