"""Measurements as CSV, for spreadsheets: RFC 4180, UTF-8, one header line."""

import csv
import io
from collections.abc import Sequence
from typing import Final

from pydantic import BaseModel

from api_schemas.bodies import EstimatedMeasurement
from api_schemas.results import Measurement

CSV: Final = "text/csv"
TABLE: Final = "measurements.csv"
"""The file's name."""


class _Measured(BaseModel):
    """The measurements of a result document, whatever else there is in it."""

    measurements: tuple[Measurement, ...]


def measurements_csv(measurements: Sequence[Measurement | EstimatedMeasurement]) -> bytes:
    """One line per measurement, one column per field; an unknown standard error stays empty."""
    fields = (type(measurements[0]) if measurements else Measurement).model_fields
    text = io.StringIO(newline="")
    table = csv.DictWriter(text, list(fields))
    table.writeheader()
    for each in measurements:
        table.writerow({name: _cell(value) for name, value in each.model_dump().items()})
    return text.getvalue().encode()


def measurements_csv_of(result: bytes) -> bytes:
    """The same of a result document, of a fit or of several combined."""
    return measurements_csv(_Measured.model_validate_json(result).measurements)


def _cell(value: object) -> object:
    """As JSON has it, which spreadsheets read too."""
    return str(value).lower() if isinstance(value, bool) else value
