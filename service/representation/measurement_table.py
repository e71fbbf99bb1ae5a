"""Measurements as CSV, for spreadsheets."""

from collections.abc import Sequence
from typing import Final

from pydantic import BaseModel

from api_schemas.bodies import EstimatedMeasurement
from api_schemas.results import Measurement
from service.representation.csv_table import models_csv

CSV: Final = "text/csv"
TABLE: Final = "measurements.csv"
"""The file's name."""


class _Measured(BaseModel):
    """The measurements of a result document, whatever else there is in it."""

    measurements: tuple[Measurement, ...]


def measurements_csv(measurements: Sequence[Measurement | EstimatedMeasurement]) -> bytes:
    """One line per measurement, one column per field; an unknown standard error stays empty."""
    fields = (type(measurements[0]) if measurements else Measurement).model_fields
    return models_csv(measurements, fields)


def measurements_csv_of(result: bytes) -> bytes:
    """The same of a result document, of a fit or of several combined."""
    return measurements_csv(_Measured.model_validate_json(result).measurements)
