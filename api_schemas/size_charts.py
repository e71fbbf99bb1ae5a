"""Size charts on the wire, and what may be wrong with one."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, Final, Self

from pydantic import Discriminator, Field, Tag, model_validator

from api_schemas.base import WireModel, refusal
from api_schemas.labels import READABLE, ReadableText
from api_schemas.measurement_names import unknown_name_remedy
from api_schemas.person import MeasurementName
from fitter.vocabulary.measurements import MEASUREMENT_UNITS
from fitter.vocabulary.reach import USUAL_REACH, other_unit

MAX_SIZES: Final = 200
MAX_LABEL_LENGTH: Final = 64
LARGEST_VALUE: Final = 500.0
"""Centimetres or kilograms; beyond it a chart is in millimetres or pounds."""

BodyValue = Annotated[
    float, Field(gt=0.0, le=LARGEST_VALUE, description="In the measurement's unit, cm or kg.")
]


class BodyRange(WireModel):
    """The bodies a size is made for, from ``low`` to ``high``."""

    low: BodyValue = Field(examples=[94.0])
    high: BodyValue = Field(examples=[98.0])

    @model_validator(mode="after")
    def _rises(self) -> Self:
        if self.low > self.high:
            raise refusal(
                code="low-above-high",
                reason=f"The range goes from {self.low:g} down to {self.high:g}.",
                remedy="Send the smaller value as low.",
            )
        return self


def _kind(value: object) -> str:
    return "[range]" if isinstance(value, Mapping | BodyRange) else "[target]"


BodyOfSize = Annotated[
    Annotated[BodyValue, Tag("[target]")] | Annotated[BodyRange, Tag("[range]")],
    Discriminator(_kind),
]


class Size(WireModel):
    """One size: for which bodies it is made, by the names of a result's measurements."""

    label: ReadableText = Field(
        min_length=1, max_length=MAX_LABEL_LENGTH, description=READABLE, examples=["M"]
    )
    measurements: dict[MeasurementName, BodyOfSize] = Field(
        min_length=1,
        description=(
            "A range of the body, or one value that it is made for: a target, which stands for the "
            "range that reaches half way to the nearest other targets. All sizes give ranges of a "
            "measurement, or all give targets. Of what is left out the size says nothing."
        ),
        examples=[{"chest_girth": {"low": 94, "high": 98}, "hip_girth": 101}],
    )


class SizeChart(WireModel):
    """Sizes in the order in which they are answered."""

    sizes: tuple[Size, ...] = Field(min_length=1, max_length=MAX_SIZES)

    @property
    def columns(self) -> tuple[str, ...]:
        """The measurements that any size names, in the order of their first mention."""
        return tuple(dict.fromkeys(name for size in self.sizes for name in size.measurements))


@dataclass(frozen=True, slots=True, kw_only=True)
class ChartFault:
    """What is wrong with a chart: in which of its sizes, counted from 0, and which column."""

    code: str
    reason: str
    remedy: str
    size: int | None = None
    column: str | None = None

    @property
    def path(self) -> str:
        """The place within the chart, as fields of JSON are named."""
        if self.size is None:
            return ""
        place = f".sizes.{self.size}"
        return place + (".label" if self.column is None else f".measurements.{self.column}")


def chart_faults(chart: SizeChart) -> Iterator[ChartFault]:
    """What is wrong with a chart whose values are each in order."""
    seen: dict[str, int] = {}
    kinds: dict[str, tuple[int, bool]] = {}
    for row, size in enumerate(chart.sizes):
        if size.label in seen:
            yield ChartFault(
                code="repeated",
                size=row,
                reason=f"The label '{size.label}' is that of size {seen[size.label] + 1} already.",
                remedy="Give every size a label of its own.",
            )
        seen.setdefault(size.label, row)
        for name, value in size.measurements.items():
            if name not in MEASUREMENT_UNITS:
                yield ChartFault(
                    code="unknown-value",
                    size=row,
                    column=name,
                    reason=f"There is no measurement '{name}' (size '{size.label}').",
                    remedy=unknown_name_remedy(name),
                )
                continue
            is_range = isinstance(value, BodyRange)
            first, first_is_range = kinds.setdefault(name, (row, is_range))
            if is_range != first_is_range:
                kind, other = ("range", "target") if is_range else ("target", "range")
                yield ChartFault(
                    code="mixed-column",
                    size=row,
                    column=name,
                    reason=f"Size '{size.label}' gives a {kind} of {name}, size "
                    f"'{chart.sizes[first].label}' a {other}.",
                    remedy="Give ranges in the whole column, or targets in the whole column.",
                )
    yield from _unit_faults(chart)


def _unit_faults(chart: SizeChart) -> Iterator[ChartFault]:
    """Columns that look like another unit: none of their values is one that people have."""
    for name in chart.columns:
        rows = [row for row, size in enumerate(chart.sizes) if name in size.measurements]
        values = [_middle(chart.sizes[row].measurements[name]) for row in rows]
        found = other_unit(name, values) if name in MEASUREMENT_UNITS else None
        if found is None:
            continue
        factor, other = found
        unit, (low, high) = MEASUREMENT_UNITS[name], USUAL_REACH[name]
        yield ChartFault(
            code="out-of-range",
            size=rows[0],
            column=name,
            reason=f"{name} goes from {min(values):g} to {max(values):g} {unit}; people have "
            f"{low:g} to {high:g} {unit}. It looks like {other}.",
            remedy=f"Send {unit}: {factor * values[0]:.4g} in place of {values[0]:g}.",
        )


def _middle(value: float | BodyRange) -> float:
    return 0.5 * (value.low + value.high) if isinstance(value, BodyRange) else value


def columns_without_step(chart: SizeChart) -> tuple[str, ...]:
    """Measurements of which all sizes have one and the same target: they need a tolerance."""
    values: dict[str, set[tuple[float, float]]] = {}
    for size in chart.sizes:
        for name, value in size.measurements.items():
            ends = (value.low, value.high) if isinstance(value, BodyRange) else (value, value)
            values.setdefault(name, set()).add(ends)
    return tuple(
        name
        for name, ranges in values.items()
        if len({low + high for low, high in ranges}) == 1
        and all(low == high for low, high in ranges)
    )
