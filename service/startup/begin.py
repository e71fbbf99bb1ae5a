"""How every command starts and ends: unusable settings are reported in one line."""

import logging
import os
import sys
from collections.abc import Callable, Mapping
from typing import Final

from pydantic import ValidationError

from service.process.logs import configure_logging
from service.settings import SettingError, Settings
from service.startup.setting_faults import fault_lines, unknown_names

LOG: Final = logging.getLogger(__name__)

UNUSABLE_SETTINGS: Final = os.EX_CONFIG
"""Exit status 78: restarting is of no use, because settings or what they name cannot be used."""

UNAVAILABLE: Final = os.EX_UNAVAILABLE
"""Exit status 69: a database or storage did not answer within the time allowed."""

NOTHING: Final[Mapping[str, object]] = {}


def read_settings(command: str, given: Mapping[str, object] = NOTHING) -> Settings:
    """Read the settings of a command, or end it; options in ``given`` take precedence."""
    try:
        return Settings(**given)  # pyright: ignore[reportArgumentType]
    except ValidationError as error:
        for line in fault_lines(error, options=given):
            print(f"maquette {command}: {line}", file=sys.stderr)
        sys.exit(UNUSABLE_SETTINGS)


def begin(command: str, given: Mapping[str, object] = NOTHING) -> Settings:
    """Read the settings of a long-running process, start logging, and warn of unknown names."""
    settings = read_settings(command, given)
    configure_logging(settings.log_level, settings.log_format)
    warn_of_unknown_names()
    return settings


def warn_of_unknown_names() -> None:
    """Say which variables look like settings but are not."""
    for name, meant in unknown_names(os.environ).items():
        hint = "it is ignored" if meant is None else f"did you mean {meant}?"
        LOG.warning("There is no setting %s; %s", name, hint)


def run_told(command: str, run: Callable[[], int | None]) -> int:
    """Run a command; anything that then proves unusable or unavailable is reported in one line."""
    try:
        return run() or 0
    except Exception as error:
        told = _told(error)
        if told is None:
            raise
        status, line = told
        print(f"maquette {command}: {line}", file=sys.stderr)
        return status


def _told(error: Exception) -> tuple[int, str] | None:
    """The exit status and the line for an error that is no fault of the program's."""
    # Imported once something has failed: an estimator has no database, and this loads all of it.
    from sqlalchemy.exc import OperationalError

    from service.blobs import BlobsUnavailableError, StorageUnusableError
    from service.engine.port import DatabaseUnusableError, EngineUnavailableError

    if isinstance(error, DatabaseUnusableError | StorageUnusableError | SettingError):
        return UNUSABLE_SETTINGS, str(error)
    if isinstance(error, EngineUnavailableError | OperationalError):
        cause = getattr(error, "orig", None) or error.__cause__ or "no answer"
        line = " ".join(str(cause).split())
        return UNAVAILABLE, f"the database is not available ({line})."
    if isinstance(error, BlobsUnavailableError):
        return UNAVAILABLE, f"the storage is not available ({error})."
    return None
