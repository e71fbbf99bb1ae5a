"""What the cells and the header of a size chart say, as shops write them.

A cell holds a value or a range: ``96``, ``94-98``, ``94/98``, ``86 cm``, ``34 1/2"``, ``36½-38``;
or a range with one end: ``<66``, ``under 66``, ``106+``, ``over 106``. A header may name the unit,
``chest_girth (cm)``. Inches and pounds that are named are converted.
"""

import re
from collections.abc import Mapping
from typing import Final, NamedTuple

from api_schemas.measurement_names import OTHER_WORDS
from fitter.vocabulary.measurements import MEASUREMENT_UNITS
from fitter.vocabulary.reach import USUAL_REACH

FACTORS: Final[Mapping[str, tuple[str, float]]] = {
    **dict.fromkeys(("cm", "centimetres", "centimeters"), ("cm", 1.0)),
    **dict.fromkeys(("mm", "millimetres", "millimeters"), ("cm", 0.1)),
    **dict.fromkeys(("m", "metres", "meters"), ("cm", 100.0)),
    **dict.fromkeys(('"', "”", "″", "in", "inch", "inches"), ("cm", 2.54)),
    **dict.fromkeys(("kg", "kgs"), ("kg", 1.0)),
    **dict.fromkeys(("lb", "lbs", "pounds"), ("kg", 0.453_592)),
}
"""What a unit is written as: the unit here, and the factor that converts to it."""

NOTHING: Final = ("", "-", "–", "—", "n/a", "na", "/")
"""Cells that say nothing."""

_FRACTIONS: Final = {"½": 0.5, "¼": 0.25, "¾": 0.75, "⅛": 0.125, "⅜": 0.375, "⅝": 0.625, "⅞": 0.875}
_NUMBER: Final = rf"\d{{1,9}}(?:[.,]\d{{1,9}}|\s*[{''.join(_FRACTIONS)}]|\s+[1-7]/[248])?"
_UNIT: Final = "|".join(re.escape(unit) for unit in sorted(FACTORS, key=len, reverse=True))
_RANGE: Final = re.compile(
    rf"({_NUMBER})\s*(?:{_UNIT})?\s*(-|–|—|~|/|to)\s*({_NUMBER})\s*({_UNIT})?", re.IGNORECASE
)
_VALUE: Final = re.compile(rf"({_NUMBER})\s*({_UNIT})?", re.IGNORECASE)
_BELOW: Final = re.compile(rf"(?:<|≤|under|below|up to)\s*({_NUMBER})\s*({_UNIT})?", re.IGNORECASE)
_ABOVE: Final = re.compile(
    rf"(?:(?:>|≥|over|above|from)\s*({_NUMBER})\s*({_UNIT})?|({_NUMBER})\s*({_UNIT})?\s*\+)",
    re.IGNORECASE,
)
_LEAST_OF_SLASH: Final = 10.0
"""Smaller numbers about a stroke are a fraction of nothing."""

_HEADER_UNIT: Final = re.compile(rf"(.+?)\s*[(\[]\s*(?:in\s+)?({_UNIT})\s*[)\]]", re.IGNORECASE)


class Ends(NamedTuple):
    """What a cell holds: both ends are the same for a single value."""

    low: float
    high: float
    is_range: bool


class UnitError(Exception):
    """A cell or a header names a unit that its measurement does not have."""


def unit_of(measurement: str, written: str) -> float:
    """The factor that brings what is in a written unit to the measurement's own.

    Raises
    ------
    UnitError
        If it is a length for a weight, or a weight for a length.
    """
    unit, factor = FACTORS[written.lower()]
    if unit != MEASUREMENT_UNITS[measurement]:
        raise UnitError
    return factor


def header_of(cell: str) -> tuple[str, str | None]:
    """A column's name and the unit beside it, if there is one."""
    found = _HEADER_UNIT.fullmatch(cell)
    return (cell, None) if found is None else (found[1], found[2])


def measurement_of(name: str) -> str:
    """The measurement that a column's name can only mean; the name itself if there is none.

    A waist may be the smallest one or that at the navel, and is not guessed.
    """
    meant = OTHER_WORDS.get(name, name)
    known = [each for each in (name, meant, f"{meant}_girth") if each in MEASUREMENT_UNITS]
    return known[0] if known else name


def read_cell(measurement: str, cell: str, factor: float) -> Ends | None:
    """What a cell says, in the measurement's unit; None if that is no value and no range.

    ``factor`` is that of the header's unit, for cells that name none.

    Raises
    ------
    UnitError
        If the cell's unit is not one of the measurement.
    """

    def value(number: str, unit: str | None) -> float:
        by = factor if unit is None else unit_of(measurement, unit)
        return round(by * _number(number), 6)

    least, most = USUAL_REACH[measurement]
    if found := _RANGE.fullmatch(cell):
        low, between, high, unit = found.groups()
        if between == "/" and _number(low) < _LEAST_OF_SLASH:
            return None
        return Ends(value(low, unit), value(high, unit), is_range=True)
    if found := _VALUE.fullmatch(cell):
        alone = value(*found.groups())
        return Ends(alone, alone, is_range=False)
    if found := _BELOW.fullmatch(cell):
        high_end = value(*found.groups())
        return Ends(min(least, 0.5 * high_end), high_end, is_range=True)
    if found := _ABOVE.fullmatch(cell):
        number, unit = found.groups()[:2] if found[1] else found.groups()[2:]
        low_end = value(number, unit)
        return Ends(low_end, max(most, 1.5 * low_end), is_range=True)
    return None


def _number(text: str) -> float:
    whole, fraction = text.strip().replace(",", "."), 0.0
    if whole[-1] in _FRACTIONS:
        whole, fraction = whole[:-1], _FRACTIONS[whole[-1]]
    elif "/" in whole:
        whole, part = whole.split()
        above, below = part.split("/")
        fraction = int(above) / int(below)
    return float(whole) + fraction
