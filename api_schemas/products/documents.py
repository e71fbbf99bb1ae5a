"""Products that are documents: a page to print, a size of a chart, the share of body fat.

Size charts are read in one form: CSV in UTF-8, with commas.

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
from typing import Annotated, Final, Literal, Self

from pydantic import Field, model_validator

from api_schemas.base import WireModel, refusal
from api_schemas.labels import is_readable
from api_schemas.person import MeasurementName, unknown_name_remedy
from api_schemas.problems import FieldProblem
from api_schemas.products.base import ProductOptions, ProductResult
from fitter.vocabulary.measurements import MEASUREMENT_UNITS


class PrintOptions(ProductOptions):
    """One page in English, A4: pictures, body, measurements with how they are taken, remarks."""

    kind: Literal["print"]


class PrintResult(ProductResult):
    """``print.html``, which needs no other file."""

    kind: Literal["print"] = "print"


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
"""Ranges of the bodies that each size is made for, by its label and the measurement's name."""


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


class SizeOptions(ProductOptions):
    """The size of a chart that the person takes, with the probability of each.

    A body with its `ease` that lies outside a size's range costs, by measurement, its distance in
    steps of the chart (the median from one size to the next), and twice that where the size is too
    small. A size fits where no measurement costs more than 1. A body takes the size of least cost
    in sum among those that fit, between equal ones that whose ranges' middles are nearer. The body
    is known with an error, of all measurements together: a size's probability is the share of such
    bodies that take it.
    """

    kind: Literal["size"]
    chart_csv: str | None = Field(
        default=None,
        max_length=MAX_CHART_BYTES,
        description=(
            "The chart, unless it comes as the form's part `chart`: CSV with a header of `size` "
            "and names of measurements, then a row for each size with ranges of the body, in "
            "centimetres (a weight in kilograms). An empty cell says nothing."
        ),
        examples=[EXAMPLE],
    )
    ease: dict[MeasurementName, Annotated[float, Field(ge=-100.0, le=100.0)]] = Field(
        default_factory=dict[str, float],
        description=(
            "What is added to the body before it is compared, cm or kg, by measurement. None with "
            "a chart of bodies; with a chart of finished garments the room that they are to leave."
        ),
        examples=[{"waist_girth_navel": 4.0}],
    )

    @property
    def part(self) -> str | None:
        """The chart comes along unless it is in the request."""
        return "chart" if self.chart_csv is None else None

    @property
    def part_is_for(self) -> str | None:
        """The sizes are in it."""
        return None if self.part is None else "holds the sizes, as does the field 'chart_csv'"

    @model_validator(mode="after")
    def _chart_is_in_order(self) -> Self:
        if self.chart_csv is None:
            return self
        try:
            chart = read_chart(self.chart_csv.encode())
        except ChartError as error:
            raise refusal(
                code=NOT_A_CHART, reason=str(error), remedy=error.remedy, field="chart_csv"
            ) from error
        for each in ease_faults(self, chart):
            raise refusal(each.code, each.reason, remedy=each.remedy, field=each.field)
        return self


def ease_faults(options: SizeOptions, chart: SizeChart) -> tuple[FieldProblem, ...]:
    """Eases of measurements that the chart does not have."""
    columns = columns_of(chart)
    return tuple(
        FieldProblem(
            field=f"ease.{name}",
            code="unknown-value",
            reason=f"The chart has no column '{name}'.",
            remedy=f"Its columns are {', '.join(columns)}.",
        )
        for name in options.ease
        if name not in columns
    )


class SizeChance(WireModel):
    """One size of the chart."""

    label: str
    probability: float = Field(ge=0.0, le=1.0, description="That the person takes this size.")


class SizedMeasurement(WireModel):
    """Fit of a size in one measurement.

    ``within``, ``too_small`` and ``too_large`` are the probabilities that the person's body, with
    its ease, lies in the size's range, above it or below it.
    """

    name: str
    value: float = Field(description="Of the body, without ease.")
    unit: str
    standard_error: float
    ease: float
    low: float | None = Field(description="Of the size; null where it says nothing.")
    high: float | None
    within: float
    too_small: float
    too_large: float


class SizeResult(ProductResult):
    """The size, and ``sizes.csv``, the probabilities as a table.

    ``recommended`` is the most probable size, null where it is more probable that none fits.
    ``measurements`` speak of ``compared_with``: that size, or the one of least cost.
    """

    kind: Literal["size"] = "size"
    recommended: str | None
    compared_with: str
    none_fits: float = Field(ge=0.0, le=1.0, description="Probability that no size fits.")
    sizes: tuple[SizeChance, ...] = Field(
        description="In the chart's order; their probabilities and `none_fits` sum to 1."
    )
    measurements: tuple[SizedMeasurement, ...] = Field(
        description="What speaks for the size and against it, in the order of the chart's columns."
    )


class CompositionOptions(ProductOptions):
    """The share of fat by published regressions on girths, each with its own error.

    It is the estimate of a formula, not a finding, and no replacement for a physician's.
    """

    kind: Literal["composition"]
    age_years: float | None = Field(
        default=None,
        ge=0.0,
        le=120.0,
        description="Without it the person is taken for an adult of working age.",
    )


class BodyFatEstimate(WireModel):
    """Estimate by one regression; withheld, with reasons, for people outside its population."""

    name: str = Field(description="Stable.", examples=["us_navy", "cun_bae"])
    source: str
    population: str = Field(description="Of whom it was learned.")
    percent: float | None = Field(description="Fat in percent of the weight.")
    standard_error: float | None = Field(
        description="Of the regression and of the measurements it is made of, together."
    )
    withheld: tuple[str, ...] = Field(description="Why it says nothing; empty where it does.")


class CompositionResult(ProductResult):
    """The estimates, and ``composition.csv``, the same as a table."""

    kind: Literal["composition"] = "composition"
    bmi: float = Field(description="Body mass index, kg per square metre.")
    estimates: tuple[BodyFatEstimate, ...]
