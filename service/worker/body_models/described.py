"""The body models in the words of the wire; what this imports takes little time to load."""

from collections.abc import Mapping
from pathlib import Path

from api_schemas.body_models import BodyModelInfo, BodyModels
from fitter.fits.usable_model import usable_model
from fitter.observation.subject import MEAN_HEIGHT_M
from fitter.vocabulary.choices import Gender


def describe(models: Path | None) -> BodyModels:
    """Return the body models of a folder, or those shipped with the package.

    Raises
    ------
    ModelFileError
        If one cannot be used.
    """
    return BodyModels(models=tuple(_model_info(gender, models) for gender in Gender))


def _model_info(gender: Gender, models: Path | None) -> BodyModelInfo:
    model = usable_model(gender, models=models)
    header = model.header
    return BodyModelInfo(
        gender=gender,
        mean_height_m=MEAN_HEIGHT_M[gender],
        vertices=len(model.mean_vertices),
        triangles=len(model.triangles),
        shape_coefficients=len(model.shape_basis),
        parts=model.part_names,
        landmarks=model.landmarks.names,
        format_version=int(str(header["format_version"])),
        checksum=str(header["checksum"]),
        sources=_texts(header["sources"]),
        licences=_texts(header["licences"]),
    )


def _texts(value: object) -> tuple[str, ...]:
    if isinstance(value, str):
        return (value,)
    if isinstance(value, Mapping):
        return tuple(f"{name}: {text}" for name, text in value.items())
    return tuple(str(text) for text in value)  # pyright: ignore[reportGeneralTypeIssues]
