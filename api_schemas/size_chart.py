"""Size charts, which are read in one form: CSV in UTF-8, with commas.

::

    size,chest_girth,waist_girth_navel
    M,94-98,80-84
    L,98-102,84-88

The header is ``size`` and names of measurements. Below it every size has a row: its label, and of
each measurement the bodies it is made for, from the smaller to the larger, in centimetres (a weight
in kilograms). An empty cell says nothing.
"""

import csv
import io
import re
from collections.abc import Mapping, Sequence
from typing import Final

from api_schemas.labels import is_readable
from api_schemas.measurement_names import unknown_name_remedy
from fitter.vocabulary.measurements import MEASUREMENT_UNITS

EXAMPLE: Final = "size,chest_girth,waist_girth_navel\nM,94-98,80-84\nL,98-102,84-88\n"
FORM: Final = f"Send CSV in UTF-8 such as: {EXAMPLE!r}, in centimetres; a weight in kilograms."
MAX_CHART_BYTES: Final = 64 * 1024
MAX_SIZES: Final = 200
MAX_LABEL_LENGTH: Final = 64

NOT_A_CHART: Final = "not-a-chart"
"""The code of all that is not of the form."""

FIRST_COLUMN: Final = "size"
_RANGE: Final = re.compile(r"(\d{1,3}(?:\.\d{1,3})?)-(\d{1,3}(?:\.\d{1,3})?)")

BodyRange = tuple[float, float]
SizeChart = Mapping[str, Mapping[str, BodyRange]]
"""Of every size by its label: by the names of measurements the bodies it is made for."""


class ChartError(Exception):
    """A chart that is not of the form: the message says where, and ``remedy`` what to send."""

    def __init__(self, reason: str, *, remedy: str = FORM) -> None:
        super().__init__(reason)
        self.remedy = remedy


def read_chart(content: bytes) -> SizeChart:
    """Read a chart; raises :class:`ChartError` where it is not of the form."""
    try:
        text = content.decode("utf-8-sig")
        lines = list(csv.reader(io.StringIO(text, newline=""), strict=True))
    except (UnicodeDecodeError, csv.Error) as error:
        message = "The chart is no CSV in UTF-8."
        raise ChartError(message) from error
    rows = [[cell.strip() for cell in line] for line in lines if line]
    if not rows or rows[0][0] != FIRST_COLUMN:
        message = f"The chart does not begin with a column '{FIRST_COLUMN}'."
        raise ChartError(message)
    (_, *names), *sizes = rows
    _check_names(names)
    if not 0 < len(sizes) <= MAX_SIZES:
        message = f"The chart has {len(sizes)} sizes, not 1 to {MAX_SIZES}."
        raise ChartError(message)
    chart: dict[str, Mapping[str, BodyRange]] = {}
    for row, (label, *cells) in enumerate(sizes, start=2):
        if not 0 < len(label) <= MAX_LABEL_LENGTH or not is_readable(label) or label in chart:
            message = f"Row {row} has no label of its own, of 1 to {MAX_LABEL_LENGTH} signs."
            raise ChartError(message)
        if len(cells) != len(names) or not any(cells):
            message = f"Row {row} has {len(cells)} of {len(names)} cells, or says nothing at all."
            raise ChartError(message)
        named = zip(names, cells, strict=True)
        chart[label] = {name: _range(row, name, cell) for name, cell in named if cell}
    return chart


def columns_of(chart: SizeChart) -> tuple[str, ...]:
    """The measurements that any size speaks of, in the order of their first mention."""
    return tuple(dict.fromkeys(name for ranges in chart.values() for name in ranges))


def _check_names(names: Sequence[str]) -> None:
    for place, name in enumerate(names):
        if name not in MEASUREMENT_UNITS or name in names[:place]:
            message = f"The header names '{name[:40]}', which is no measurement of its own."
            raise ChartError(message, remedy=unknown_name_remedy(name))


def _range(row: int, name: str, cell: str) -> BodyRange:
    found = _RANGE.fullmatch(cell)
    low, high = (float(found[1]), float(found[2])) if found else (0.0, 0.0)
    if not 0.0 < low <= high:
        unit = MEASUREMENT_UNITS[name]
        message = f"Row {row}, column '{name}' holds '{cell[:40]}', no range in {unit}."
        raise ChartError(message)
    return low, high
