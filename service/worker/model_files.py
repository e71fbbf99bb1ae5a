"""Whether body models and detector can be used, asked before anything is started that needs them.

The process that asks is to stay without numerics: models of one's own are read by a process started
for it; of the packaged ones, which can only be missing or damaged, the archives' checksums do.
"""

import zipfile
import zlib
from contextlib import suppress
from pathlib import Path
from typing import Final

import fitter.body
from fitter.detection.weights import checked_weights
from fitter.errors import DetectorUnavailableError
from service.settings import SettingError, Settings
from service.worker.models_reading import ModelsBeingRead, unusable_models

PACKAGED: Final = Path(fitter.body.__path__[0]) / "data"
NAMES: Final = ("female.npz", "male.npz")


def check_models(settings: Settings) -> None:
    """Raise SettingError if the body models cannot be used."""
    if settings.models_dir is not None:
        # A process that dies of something else: the worker comes to the same and can tell.
        with suppress(RuntimeError):
            ModelsBeingRead(settings).wait()
    elif (damage := _damage(PACKAGED)) is not None:
        raise unusable_models(settings, damage)


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


def _damage(folder: Path) -> str | None:
    for name in NAMES:
        try:
            with zipfile.ZipFile(folder / name) as archive:
                broken = archive.testzip()
        except (OSError, zipfile.BadZipFile, zlib.error, EOFError) as error:
            broken = str(error)
        if broken is not None:
            return f"{name} is damaged or missing ({broken}). Install the package again."
    return None
