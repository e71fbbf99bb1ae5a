"""Whether body models and detector can be used, asked before anything is started that needs them.

The process that asks is to stay without numerics: models of one's own are read by a process forked
for it; of the packaged ones, which can only be missing or damaged, the archives' checksums do.
"""

import zipfile
import zlib
from multiprocessing import get_context
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Final

import fitter.body
from fitter.detection.weights import read_weights
from fitter.errors import DetectorUnavailableError, ModelFileError
from service.settings import SettingError, Settings

PACKAGED: Final = Path(fitter.body.__path__[0]) / "data"
NAMES: Final = ("female.npz", "male.npz")


def check_models(settings: Settings) -> None:
    """Raise SettingError if the body models cannot be used."""
    if settings.models_dir is None:
        reason = _damage(PACKAGED)
    else:
        reason = _reason_from_another_process(settings.models_dir)
    if reason is not None:
        raise unusable_models(settings, reason)


def check_detector(settings: Settings) -> None:
    """Raise SettingError if a folder is named for the detector and it cannot be used.

    Without a folder there may be a detector or none: it is optional.
    """
    if settings.detector_dir is None:
        return
    try:
        read_weights(settings.detector_dir)
    except DetectorUnavailableError as error:
        raise SettingError(str(error), name="detector_dir", value=settings.detector_dir) from error


def unusable_models(settings: Settings, reason: str) -> SettingError:
    """Say in one line which models cannot be used and why."""
    value = "(unset, the packaged models)" if settings.models_dir is None else settings.models_dir
    return SettingError(" ".join(reason.split()), name="models_dir", value=value)


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


def _reason_from_another_process(folder: Path) -> str | None:
    context = get_context("fork")
    ours, theirs = context.Pipe(duplex=False)
    process = context.Process(target=_tell_reason, args=(folder, theirs), daemon=True)
    process.start()
    theirs.close()
    try:
        return ours.recv()
    except EOFError:
        # It died of something else; the worker comes to the same and can tell.
        return None
    finally:
        ours.close()
        process.join()


def _tell_reason(folder: Path, connection: Connection) -> None:
    from service.worker import pipeline

    try:
        pipeline.describe(folder)
    except ModelFileError as error:
        connection.send(str(error))
    else:
        connection.send(None)
