"""Start and end of every command: unusable settings are reported in one line."""

import argparse
import logging
import os
import sys
from collections.abc import Callable, Collection, Iterator, Mapping
from typing import Any, Final

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from service.process.logs import configure_logging
from service.settings import NOT_SHOWN, PREFIX, SettingError, Settings, without_secrets

LOG: Final = logging.getLogger(__name__)

UNUSABLE: Final = 2
"""Exit status where arguments, or what they name, cannot be used."""

UNUSABLE_SETTINGS: Final = os.EX_CONFIG
"""Exit status 78: restarting is of no use, because settings or what they name cannot be used."""

UNAVAILABLE: Final = os.EX_UNAVAILABLE
"""Exit status 69: a database or storage did not answer within the time allowed."""

NOTHING: Final[Mapping[str, object]] = {}

Work = Callable[[Settings], int | None]


def run_command(command: str, work: Work, options: Mapping[str, object] = NOTHING) -> int:
    """Read the settings and run a command with them; ``options`` take precedence.

    What proves unusable or unavailable is reported in a line. Returns the exit status.
    """
    settings = _read_settings(command, options)
    _warn_of_unknown_names()
    return _run(command, work, settings)


def run_service(command: str, work: Work, options: Mapping[str, object] = NOTHING) -> int:
    """Run a process that stays, which logs, as :func:`run_command` does."""
    settings = _read_settings(command, options)
    configure_logging(settings.log_level, settings.log_format)
    _warn_of_unknown_names()
    return _run(command, work, settings)


def given(parsed: argparse.Namespace, *names: str) -> dict[str, object]:
    """Those of these options that stand on the command line."""
    return {name: value for name in names if (value := getattr(parsed, name)) is not None}


def _read_settings(command: str, options: Mapping[str, object]) -> Settings:
    try:
        return Settings(**options)  # pyright: ignore[reportArgumentType]
    except ValidationError as error:
        for line in fault_lines(error, options=options):
            print(f"maquette {command}: {line}", file=sys.stderr)
        sys.exit(UNUSABLE_SETTINGS)


def _warn_of_unknown_names() -> None:
    for name in unknown_names(os.environ):
        LOG.warning("There is no setting %s; it is ignored.", name)


def _run(command: str, work: Work, settings: Settings) -> int:
    try:
        return work(settings) or 0
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

    from service.jobs.blobs import BlobsUnavailableError, StorageUnusableError
    from service.jobs.records import DatabaseUnusableError, EngineUnavailableError

    if isinstance(error, DatabaseUnusableError | StorageUnusableError | SettingError):
        return UNUSABLE_SETTINGS, str(error)
    if isinstance(error, EngineUnavailableError | OperationalError):
        cause = getattr(error, "orig", None) or error.__cause__ or "no answer"
        line = " ".join(str(cause).split())
        return UNAVAILABLE, f"the database is not available ({line})."
    if isinstance(error, BlobsUnavailableError):
        return UNAVAILABLE, f"the storage is not available ({error})."
    return None


ADDRESSES: Final = frozenset({"database_url", "blob_url"})
SECRETS: Final = frozenset({"webhook_secret"})

LONGEST_SHOWN: Final = 200


def fault_lines(error: ValidationError, *, options: Collection[str] = ()) -> Iterator[str]:
    """Describe every fault of the settings; ``options`` were given on the command line instead."""
    for fault in error.errors():
        name = str(fault["loc"][0]) if fault["loc"] else ""
        option = f"--{name.replace('_', '-')}"
        label = option if name in options else PREFIX + name.upper()
        yield f"{label}={_shown(name, fault['input'])}: {_reason(fault)}."


def unknown_names(environment: Mapping[str, str]) -> list[str]:
    """Variables named like settings that are none."""
    known = {PREFIX + name.upper() for name in Settings.model_fields}
    return [
        name
        for name in sorted(environment)
        if name.upper().startswith(PREFIX) and name.upper() not in known
    ]


def _shown(name: str, value: object) -> str:
    if name in SECRETS:
        return NOT_SHOWN
    text = without_secrets(str(value)) if name in ADDRESSES else str(value)
    # One line, whatever is in it.
    printable = "".join(each if each.isprintable() else "?" for each in text)
    return printable if len(printable) <= LONGEST_SHOWN else f"{printable[:LONGEST_SHOWN]}..."


def _reason(fault: ErrorDetails) -> str:
    context: Mapping[str, Any] = fault.get("ctx", {})
    if fault["type"] == "value_error":
        return str(context["error"])
    if "remedy" in context:  # a refusal of our own
        return f"{context['reason'].rstrip('.')}. {context['remedy'].rstrip('.')}"
    return f"{fault['msg']}; correct it, or unset it"
