"""Size charts as tables: CSV as spreadsheets write it.

The first line names the columns, the first of which holds the sizes' labels. Every other one is
named by a measurement, and holds ``94-98``, a range, or ``96``, a target
(:mod:`api_schemas.size_chart_cells`); or it is one of a pair ``chest_girth_low`` and
``chest_girth_high``, or ``_min`` and ``_max``. Empty cells say nothing. Columns are parted by
commas, semicolons or tabs; between the latter two a comma may be decimal. Excel's line ``sep=;``
before all says which.
"""

import csv
import io
import re
from collections.abc import Mapping, Sequence
from typing import Final, NamedTuple

from api_schemas.labels import READABLE_REMEDY, is_readable
from api_schemas.measurement_names import unknown_name_remedy
from api_schemas.size_chart_cells import (
    NOTHING,
    UnitError,
    header_of,
    measurement_of,
    read_cell,
    unit_of,
)
from api_schemas.size_charts import (
    LARGEST_VALUE,
    MAX_LABEL_LENGTH,
    MAX_SIZES,
    BodyRange,
    ChartFault,
    Size,
    SizeChart,
    chart_faults,
)
from fitter.vocabulary.measurements import MEASUREMENT_UNITS

MAX_CHART_BYTES: Final = 256 * 1024
MAX_COLUMNS: Final = 200

_LOW, _HIGH = "_low", "_high"
_ENDINGS: Final = {"_min": _LOW, "_max": _HIGH}
_SEPARATOR: Final = re.compile(r"\ufeff?\s*\"?sep=([,;\t])\"?[,;\t]*\r?\n", re.IGNORECASE)


class ChartTableError(Exception):
    """A table that is no size chart; names the row as a spreadsheet counts it, and the column."""

    def __init__(self, *, code: str, reason: str, remedy: str) -> None:
        super().__init__(reason)
        self.code = code
        self.reason = reason
        self.remedy = remedy


class _Row(NamedTuple):
    """``number`` is that of the line; ``factors``, by column, convert from the header's units."""

    number: int
    label: str
    cells: Mapping[str, str]
    factors: Mapping[str, float]


def read_chart(content: bytes) -> SizeChart:
    """Read a table.

    Raises
    ------
    ChartTableError
        If it is none, or a cell or the chart is at fault.
    """
    rows = _rows(_text(content))
    sizes = tuple(_size(row) for row in rows)
    chart = SizeChart(sizes=sizes)
    for fault in chart_faults(chart):
        raise _located(fault, rows)
    return chart


def _text(content: bytes) -> str:
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ChartTableError(
            code="not-a-table",
            reason="The chart is no text in UTF-8.",
            remedy="Save it as CSV in UTF-8, with commas, semicolons or tabs between the columns.",
        ) from error


def _rows(text: str) -> list[_Row]:
    header, *lines = _lines(text)
    columns, factors = _columns(header[1])
    rows: list[_Row] = []
    for number, cells in lines:
        if any(cells[len(columns) + 1 :]):
            raise ChartTableError(
                code="not-a-table",
                reason=f"Row {number} has more cells than the header.",
                remedy="Give every column a name, and put ranges with commas in quotes.",
            )
        label = cells[0]
        if not 0 < len(label) <= MAX_LABEL_LENGTH:
            raise ChartTableError(
                code="missing" if not label else "wrong-length",
                reason=f"Row {number} has no label of 1 to {MAX_LABEL_LENGTH} characters.",
                remedy="Put the size's label into the first column.",
            )
        if not is_readable(label):
            raise ChartTableError(
                code="unreadable-label",
                reason=f"Row {number} has characters in its label that are not seen.",
                remedy=READABLE_REMEDY,
            )
        said = ["" if cell.lower() in NOTHING else cell for cell in cells[1:]]
        rows.append(_Row(number, label, dict(zip(columns, said, strict=False)), factors))
    if not rows:
        raise ChartTableError(
            code="no-sizes",
            reason="The chart has no rows below its header.",
            remedy="Give every size a row.",
        )
    if len(rows) > MAX_SIZES:
        raise ChartTableError(
            code="wrong-length",
            reason=f"The chart has {len(rows)} rows, more than {MAX_SIZES}.",
            remedy=f"Send at most {MAX_SIZES} sizes.",
        )
    return rows


def _lines(text: str) -> list[tuple[int, list[str]]]:
    """Lines that are not empty, with their numbers."""
    told = _SEPARATOR.match(text)
    if told is not None:
        # The line stays counted: rows are named as a spreadsheet numbers them.
        text = "\n" + text[told.end() :]
    head = text.lstrip().partition("\n")[0]
    delimiter = told[1] if told is not None else max("\t;,", key=head.count)
    try:
        table = list(csv.reader(io.StringIO(text, newline=""), delimiter=delimiter, strict=True))
    except csv.Error as error:
        raise ChartTableError(
            code="not-a-table",
            reason=f"The chart cannot be read as CSV: {error}.",
            remedy="Save it as CSV.",
        ) from error
    stripped = [(number, [cell.strip() for cell in line]) for number, line in enumerate(table, 1)]
    lines = [(number, cells) for number, cells in stripped if any(cells)]
    if not lines:
        raise ChartTableError(
            code="no-sizes",
            reason="The chart is empty.",
            remedy="Send a header and a row for every size.",
        )
    return lines


def _columns(header: Sequence[str]) -> tuple[list[str], dict[str, float]]:
    """Names of the columns behind the labels, and the factor of each that has a unit."""
    cells = list(header[1:])
    while cells and not cells[-1]:
        cells.pop()
    if not cells or len(cells) > MAX_COLUMNS:
        raise ChartTableError(
            code="not-a-table",
            reason=f"The header names {len(cells)} measurements, not 1 to {MAX_COLUMNS}.",
            remedy="Begin with a line such as: size,chest_girth,waist_girth_navel",
        )
    columns: list[str] = []
    units: list[str | None] = []
    for cell in cells:
        said, unit = header_of(cell)
        columns.append(_column(said))
        units.append(unit)
    factors: dict[str, float] = {}
    for place, (name, unit) in enumerate(zip(columns, units, strict=True), start=2):
        _check_name(name, columns, place)
        if unit is not None:
            try:
                factors[name] = unit_of(name.removesuffix(_LOW).removesuffix(_HIGH), unit)
            except UnitError as error:
                raise ChartTableError(
                    code="not-a-range",
                    reason=f"Row 1, column '{name}': '{unit}' is no unit of this measurement.",
                    remedy="Give lengths in centimetres and a weight in kilograms.",
                ) from error
    return columns, factors


def _column(said: str) -> str:
    """A column's name as measurements are written here, with the end of a range that it holds."""
    name = re.sub(r"[\s-]+", "_", said.lower())
    for ending in (*_ENDINGS, _LOW, _HIGH):
        if name.endswith(ending):
            return measurement_of(name.removesuffix(ending)) + _ENDINGS.get(ending, ending)
    return measurement_of(name)


def _check_name(name: str, columns: Sequence[str], place: int) -> None:
    if not name or name in columns[: place - 2]:
        raise ChartTableError(
            code="repeated" if name else "missing",
            reason=f"Column {place} has "
            + (f"the name '{name}' of another one." if name else "no name."),
            remedy="Give every column the name of a measurement of its own.",
        )
    for ending, other in ((_LOW, _HIGH), (_HIGH, _LOW)):
        stem = name.removesuffix(ending)
        if name.endswith(ending) and (stem + other not in columns or stem in columns):
            raise ChartTableError(
                code="missing" if stem + other not in columns else "repeated",
                reason=f"The column '{name}' stands without '{stem}{other}', or beside '{stem}'.",
                remedy=f"Give both '{stem}{_LOW}' and '{stem}{_HIGH}', or '{stem}' alone.",
            )
    stem = name.removesuffix(_LOW).removesuffix(_HIGH)
    if stem not in MEASUREMENT_UNITS:
        raise ChartTableError(
            code="unknown-value",
            reason=f"Row 1, column '{name[:MAX_LABEL_LENGTH]}': no measurement has this name.",
            remedy=unknown_name_remedy(stem),
        )


def _size(row: _Row) -> Size:
    measurements: dict[str, float | BodyRange] = {}
    for column, cell in row.cells.items():
        if column.endswith(_HIGH):
            continue
        name = column.removesuffix(_LOW)
        if column.endswith(_LOW):
            other = row.cells.get(name + _HIGH, "")
            if bool(cell) != bool(other):
                raise _cell_error(row, column, "missing", "has a low or a high end alone")
            cell = f"{cell}-{other}" if cell else ""
        if cell:
            measurements[name] = _value(row, column, cell)
    if not measurements:
        raise ChartTableError(
            code="missing",
            reason=f"Row {row.number} ('{row.label}') says nothing of any measurement.",
            remedy="Give at least one range or target in every row.",
        )
    return Size(label=row.label, measurements=measurements)


def _value(row: _Row, column: str, cell: str) -> float | BodyRange:
    measurement = column.removesuffix(_LOW)
    try:
        ends = read_cell(measurement, cell, row.factors.get(column, 1.0))
    except UnitError as error:
        fault = f"holds '{cell[:40]}', whose unit is none of this measurement"
        raise _cell_error(row, column, "not-a-range", fault) from error
    if ends is None:
        raise _cell_error(row, column, "not-a-range", f"holds '{cell[:40]}', no number or range")
    if not all(0.0 < end <= LARGEST_VALUE for end in ends[:2]):
        raise _cell_error(
            row,
            column,
            "out-of-range",
            f"holds {cell[:40]}, beyond 0 to {LARGEST_VALUE:g} cm or kg",
        )
    if ends.low > ends.high:
        fault = f"goes from {ends.low:g} down to {ends.high:g}"
        raise _cell_error(row, column, "low-above-high", fault)
    return BodyRange(low=ends.low, high=ends.high) if ends.is_range else ends.low


def _cell_error(row: _Row, column: str, code: str, fault: str) -> ChartTableError:
    return ChartTableError(
        code=code,
        reason=f"Row {row.number} ('{row.label}'), column '{column}' {fault}.",
        remedy="Give a range such as 94-98, or one value, in centimetres; a weight in kilograms.",
    )


def _located(fault: ChartFault, rows: Sequence[_Row]) -> ChartTableError:
    row = rows[fault.size or 0]
    where = f"Row {row.number}" + ("" if fault.column is None else f", column '{fault.column}'")
    return ChartTableError(code=fault.code, reason=f"{where}: {fault.reason}", remedy=fault.remedy)
