"""Values in the units that were asked for."""

from typing import Final

from api_schemas.derivation_kinds.report import Units
from service.worker.derived.report.wording import Figures

CM_PER_INCH: Final = 2.54
KG_PER_POUND: Final = 0.45359237


def in_units(value: float, unit: str, units: Units) -> tuple[float, str]:
    """Convert a value in centimetres or kilograms, and name its unit."""
    if units is Units.METRIC:
        return value, unit
    if unit == "kg":
        return value / KG_PER_POUND, "lb"
    return value / CM_PER_INCH, "in"


def height_in_words(height_m: float, units: Units, figures: Figures) -> str:
    """A person's height, as it is said."""
    value, unit = in_units(100.0 * height_m, "cm", units)
    return f"{figures.number(value, '.1f')} {unit}"
