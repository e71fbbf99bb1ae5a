"""Measurements and other rows as CSV, for spreadsheets: RFC 4180, UTF-8, one header line.

A spreadsheet takes a text that begins like a formula for one, and runs it: what somebody has typed
into a size chart could read the other cells and send them away. Such a text gets an apostrophe,
which spreadsheets take for "this is text".
"""

import csv
import io
from collections.abc import Iterable, Sequence
from typing import Final, cast

from pydantic import BaseModel

from api_schemas.results import Measurement

FORMULAS: Final = tuple("=+-@\t\r\n\uff1d\uff0b\uff0d\uff20")
"""First characters of cells that some spreadsheet takes for formulas, full-width ones included."""


def models_csv(rows: Sequence[BaseModel], fields: Iterable[str]) -> bytes:
    """One line per row, one column per field; what is unknown stays empty."""
    text = io.StringIO(newline="")
    table = csv.DictWriter(text, list(fields))
    table.writeheader()
    for each in rows:
        table.writerow({name: _cell(value) for name, value in each.model_dump().items()})
    return text.getvalue().encode()


def _cell(value: object) -> object:
    """As JSON has it, which spreadsheets read too; several values in one cell, by semicolons."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, tuple):
        value = "; ".join(map(str, cast("tuple[object, ...]", value)))
    if isinstance(value, str) and any(each.startswith(FORMULAS) for each in (value, value.strip())):
        return f"'{value}"
    return value


CSV: Final = "text/csv"
TABLE: Final = "measurements.csv"
"""The file's name."""


class _Measured(BaseModel):
    """The measurements of a result document, whatever else there is in it."""

    measurements: tuple[Measurement, ...]


def measurements_csv(measurements: Sequence[Measurement]) -> bytes:
    """One line per measurement, one column per field; an unknown standard error stays empty."""
    return models_csv(measurements, Measurement.model_fields)


def measurements_csv_of(result: bytes) -> bytes:
    """The same of a result document."""
    return measurements_csv(_Measured.model_validate_json(result).measurements)
