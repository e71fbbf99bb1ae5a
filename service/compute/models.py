"""Body models that there are, and whether they can be used, as another process finds out.

A worker loads no numerics, and its fork server is not to be waited for: ``python -m
service.compute.models [FOLDER]`` describes the models on its standard output.
"""

import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from api_schemas.service import BodyModelInfo, BodyModels
from fitter.detection.weights import checked_weights
from fitter.errors import DetectorUnavailableError, ModelFileError
from fitter.vocabulary.choices import Gender
from service.process.supervisor import PYTHON
from service.settings import SettingError, Settings

COMMAND: Final = (*PYTHON, "-m", "service.compute.models")

UNUSABLE: Final = 2
"""Exit status if a model cannot be used; standard output says why."""


def read_models(settings: Settings) -> BodyModels:
    """Have the body models read and described.

    Raises
    ------
    SettingError
        If one cannot be used.
    RuntimeError
        If the process that reads them dies.
    """
    folder = () if settings.models_dir is None else (str(settings.models_dir),)
    # A session of its own: an interrupt from the terminal is for those who wait.
    done = subprocess.run(
        (*COMMAND, *folder),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        start_new_session=True,
        check=False,
    )
    if done.returncode == UNUSABLE:
        value = settings.models_dir or "(unset, the packaged models)"
        reason = " ".join(done.stdout.decode().split())
        raise SettingError(reason, name="models_dir", value=value)
    if done.returncode != 0:
        fault = f"Reading the body models died, exit code {done.returncode}."
        raise RuntimeError(fault)
    return BodyModels.model_validate_json(done.stdout)


def check_models(settings: Settings) -> None:
    """Raise SettingError if a folder is named for the body models and they cannot be used."""
    if settings.models_dir is not None:
        read_models(settings)


def check_detector(settings: Settings) -> None:
    """Raise SettingError if a folder is named for the detector and it cannot be used.

    Without a folder there may be a detector or none: it is optional.
    """
    if settings.detector_dir is None:
        return
    try:
        checked_weights(settings.detector_dir)
    except DetectorUnavailableError as error:
        raise SettingError(str(error), name="detector_dir", value=settings.detector_dir) from error


def describe(models: Path | None) -> BodyModels:
    """Return the body models of a folder, or those shipped with the package.

    Raises
    ------
    ModelFileError
        If one cannot be used.
    """
    return BodyModels(models=tuple(_model_info(gender, models) for gender in Gender))


def _model_info(gender: Gender, models: Path | None) -> BodyModelInfo:
    # Imported here: whoever has the models read loads no numerics.
    from fitter.fits.usable_model import usable_model
    from fitter.observation.subject import MEAN_HEIGHT_M

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


def _main() -> int:
    try:
        print(describe(Path(sys.argv[1]) if sys.argv[1:] else None).model_dump_json())
    except ModelFileError as error:
        print(error)
        return UNUSABLE
    return 0


if __name__ == "__main__":
    sys.exit(_main())
