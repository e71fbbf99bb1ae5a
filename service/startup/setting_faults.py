"""What is wrong with settings, one line per fault: the variable, its value, the remedy."""

import difflib
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any, Final

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from service.setting_addresses import NOT_SHOWN, without_secrets
from service.settings import PREFIX, Settings

ADDRESSES: Final = frozenset({"database_url", "blob_url", "s3_endpoint_url"})
SECRETS: Final = frozenset({"webhook_secret"})

LONGEST_SHOWN: Final = 200
LIKENESS: Final = 0.6
"""How similar a name, after the prefix, must be to one of ours to be taken for a misspelling."""

_BOUNDS: Final[Mapping[str, str]] = {
    "greater_than": "it must be above {gt:g}",
    "greater_than_equal": "it must be at least {ge:g}",
    "less_than": "it must be below {lt:g}",
    "less_than_equal": "it must be at most {le:g}",
    "finite_number": "it must be a finite number",
}


def fault_lines(error: ValidationError, *, options: Collection[str] = ()) -> Iterator[str]:
    """Describe every fault of the settings; ``options`` were given on the command line instead."""
    for fault in error.errors():
        name = str(fault["loc"][0]) if fault["loc"] else ""
        option = f"--{name.replace('_', '-')}"
        label = option if name in options else PREFIX + name.upper()
        yield f"{label}={_shown(name, fault['input'])}: {_reason(name, fault)}."


def unknown_names(environment: Mapping[str, str]) -> dict[str, str | None]:
    """Variables named like settings that are none, each with the setting that may be meant."""
    known = [name.upper() for name in Settings.model_fields]
    named = {
        name: name.upper().removeprefix(PREFIX)
        for name in sorted(environment)
        if name.upper().startswith(PREFIX)
    }
    return {name: _nearest(slip, known) for name, slip in named.items() if slip not in known}


def _nearest(slip: str, known: Sequence[str]) -> str | None:
    found = difflib.get_close_matches(slip, known, n=1, cutoff=LIKENESS)
    return PREFIX + found[0] if found else None


def _shown(name: str, value: object) -> str:
    if name in SECRETS:
        return NOT_SHOWN
    text = without_secrets(str(value)) if name in ADDRESSES else str(value)
    # One line, whatever is in it.
    printable = "".join(each if each.isprintable() else "?" for each in text)
    return printable if len(printable) <= LONGEST_SHOWN else f"{printable[:LONGEST_SHOWN]}..."


def _reason(name: str, fault: ErrorDetails) -> str:
    context: Mapping[str, Any] = fault.get("ctx", {})
    if fault["type"] == "value_error":
        return str(context["error"])
    if "remedy" in context:  # a refusal of our own
        return f"{context['reason'].rstrip('.')}. {context['remedy'].rstrip('.')}"
    if fault["type"] in _BOUNDS:
        reason = _BOUNDS[fault["type"]].format_map(context)
    else:
        reason = fault["msg"][:1].lower() + fault["msg"][1:]
    return f"{reason}; {_way_out(name)}"


def _way_out(name: str) -> str:
    field = Settings.model_fields.get(name)
    if field is None or field.default is None or field.default_factory is not None:
        return "correct it, or unset it"
    return f"correct it, or unset it for the default, {field.default}"
