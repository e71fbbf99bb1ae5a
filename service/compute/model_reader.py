"""Read the body models and describe them: ``python -m service.compute.model_reader [FOLDER]``."""

import os
import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path

from api_schemas.service import BodyModelInfo, BodyModels
from fitter.errors import ModelFileError
from fitter.fits.usable_model import usable_model
from fitter.observation.subject import MEAN_HEIGHT_M
from fitter.vocabulary.choices import Gender
from service.compute.models_reading import (
    MODELS_MESSAGES,
    DescriptionMessage,
    ModelsMessage,
    UnusableModelsMessage,
)


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


def tell(describe: Callable[[Path | None], BodyModels]) -> None:
    """Describe the models of the folder named by the argument, without one the packaged ones."""
    folder = Path(sys.argv[1]) if sys.argv[1:] else None
    try:
        message: ModelsMessage = DescriptionMessage(body_models=describe(folder))
    except ModelFileError as error:
        message = UnusableModelsMessage(reason=str(error))
    # Not through sys.stdout, whose end would meet a reader that is gone where nobody can bear it.
    with suppress(BrokenPipeError):
        os.write(sys.stdout.fileno(), MODELS_MESSAGES.dump_json(message))


if __name__ == "__main__":
    tell(describe)
