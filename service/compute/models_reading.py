"""Which body models there are, and whether they can be used, as another process finds out.

A worker loads no numerics, and its fork server is not to be waited for: whoever wants to know
starts :mod:`service.compute.model_reader`, which says one message on its standard output.
"""

import logging
import subprocess
import zipfile
import zlib
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Annotated, Final, Literal

from pydantic import Field, TypeAdapter, ValidationError

import fitter.body
from api_schemas.base import WireModel
from api_schemas.service import BodyModels
from fitter.detection.weights import checked_weights
from fitter.errors import DetectorUnavailableError
from service.process.supervisor import PYTHON
from service.settings import SettingError, Settings

LOG: Final = logging.getLogger(__name__)

COMMAND: Final = (*PYTHON, "-m", "service.compute.model_reader")

READINGS: Final = 3
"""How often the body models are read: the process that does may be killed for other reasons."""


class DescriptionMessage(WireModel):
    """The body models there are."""

    kind: Literal["description"] = "description"
    body_models: BodyModels


class UnusableModelsMessage(WireModel):
    """The body models cannot be used."""

    kind: Literal["unusable-models"] = "unusable-models"
    reason: str


ModelsMessage = Annotated[DescriptionMessage | UnusableModelsMessage, Field(discriminator="kind")]
MODELS_MESSAGES: Final[TypeAdapter[ModelsMessage]] = TypeAdapter(ModelsMessage)


class ModelsBeingRead:
    """The body models while another process reads them, which it begins to do at once."""

    def __init__(self, settings: Settings, *, command: Sequence[str] = COMMAND) -> None:
        self._settings = settings
        folder = () if settings.models_dir is None else (str(settings.models_dir),)
        self._command = (*command, *folder)
        self._process = self._start()

    def wait(self) -> BodyModels:
        """Wait for the description; called once.

        Raises
        ------
        SettingError
            If the models cannot be used.
        RuntimeError
            If the process dies, however often it is started.
        """
        for reading in range(READINGS):
            if reading > 0:
                self._process = self._start()
            message = self._message()
            if isinstance(message, UnusableModelsMessage):
                raise unusable_models(self._settings, message.reason)
            if message is not None:
                return message.body_models
        fault = "The body models cannot be read; the lines above say more."
        raise RuntimeError(fault)

    def _start(self) -> subprocess.Popen[bytes]:
        # A session of its own: an interrupt from the terminal is for those who wait.
        return subprocess.Popen(
            self._command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            start_new_session=True,
        )

    def _message(self) -> ModelsMessage | None:
        said, _ = self._process.communicate()
        try:
            return MODELS_MESSAGES.validate_json(said)
        except ValidationError:
            LOG.warning("Reading the body models died, exit code %s.", self._process.returncode)
            return None


def unusable_models(settings: Settings, reason: str) -> SettingError:
    """Say in one line which models cannot be used and why."""
    value = "(unset, the packaged models)" if settings.models_dir is None else settings.models_dir
    return SettingError(" ".join(reason.split()), name="models_dir", value=value)


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
