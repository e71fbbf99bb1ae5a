"""A size: what is asked for, and what comes of it."""

from collections.abc import Mapping
from typing import Annotated, Final, Literal, Self

from pydantic import Field, model_validator

from api_schemas.base import WireModel, refusal
from api_schemas.derivation_kinds.base import DerivationOptions, DerivedFiles
from api_schemas.person import MeasurementName
from api_schemas.problems import FieldProblem
from api_schemas.results import FitWarning
from api_schemas.size_chart_csv import MAX_CHART_BYTES, ChartTableError, read_chart
from api_schemas.size_charts import SizeChart, chart_faults, columns_without_step
from fitter.vocabulary.outcomes import SizedAs

CHART: Final = "chart"
"""The field, and the part of a form, that hold the chart."""

CHART_CSV: Final = "chart_csv"

Ease = Annotated[float, Field(ge=-100.0, le=100.0, examples=[4.0])]
Allowed = Annotated[float, Field(gt=0.0, le=500.0)]


class SizeTolerance(WireModel):
    """How far a body may lie outside a size's range for the size still to fit, cm or kg."""

    too_small: Allowed = Field(
        description="The size is too small for the body: too tight or too short.", examples=[1.0]
    )
    too_large: Allowed = Field(description="The size is too large for it.", examples=[4.0])


class SizeOptions(DerivationOptions):
    """The size of a chart that the person takes, with the probability of each.

    Of every measurement of the chart v = body + `ease` is compared with a size's range from `low`
    to `high`. What lies outside costs max(v - high, 0) / too_small + max(low - v, 0) / too_large,
    with the tolerances of that measurement: by default too_large is a step of the chart (the median
    distance between the middles of neighbouring sizes), and too_small half a step, so that too
    small counts twice. A size fits where no measurement costs more than 1. A body takes the size of
    least total cost among those that fit; between equal ones that whose middles are nearer. The
    body is known with an error, of all measurements together: a size's probability is the share of
    such bodies that take it.
    """

    kind: Literal["size"]
    chart: SizeChart | None = Field(
        default=None,
        description="The chart; as a table it comes as the form's part `chart` or in `chart_csv`.",
    )
    chart_csv: str | None = Field(
        default=None,
        max_length=MAX_CHART_BYTES,
        description=(
            "The chart as CSV: a header `size,chest_girth,waist_girth_navel`, then a row for each "
            "size, `M,94-98,80-84`. A cell is a range, a single target, or empty; columns "
            "`chest_girth_low` and `chest_girth_high` do as well."
        ),
        examples=["size,chest_girth,waist_girth_navel\nM,94-98,80-84\nL,98-102,84-88\n"],
    )
    ease: dict[MeasurementName, Ease] = Field(
        default_factory=dict[str, float],
        description=(
            "What is added to the body before it is compared, cm or kg, by measurement. None with "
            "a chart of bodies, or as much more room as the person likes (less, if negative); "
            "with a chart of finished garments the room that they are to leave."
        ),
    )
    tolerances: dict[MeasurementName, SizeTolerance] = Field(
        default_factory=dict[str, SizeTolerance],
        description="By measurement; steps of the chart where none are given.",
    )

    @model_validator(mode="after")
    def _chart_is_in_order(self) -> Self:
        if self.chart is not None and self.chart_csv is not None:
            raise refusal(
                code="two-charts",
                reason="Both chart and chart_csv are given.",
                field=CHART_CSV,
                remedy="Send one of the two.",
            )
        if self.chart is not None:
            for fault in chart_faults(self.chart):
                field = f"{CHART}{fault.path}"
                raise refusal(fault.code, fault.reason, remedy=fault.remedy, field=field)
        try:
            sent = self.sent_chart
        except ChartTableError as error:
            raise refusal(error.code, error.reason, remedy=error.remedy, field=CHART_CSV) from error
        if sent is not None:
            for each in options_faults(self, sent):
                raise refusal(each.code, each.reason, remedy=each.remedy, field=each.field)
        return self

    @property
    def sent_chart(self) -> SizeChart | None:
        """The chart within the request; None where it comes along as a file."""
        return self.chart if self.chart_csv is None else read_chart(self.chart_csv.encode())


def options_faults(options: SizeOptions, chart: SizeChart) -> tuple[FieldProblem, ...]:
    """What of the options does not go with the chart."""
    names = chart.columns
    given: Mapping[str, Mapping[str, object]] = {
        "ease": options.ease,
        "tolerances": options.tolerances,
    }
    unknown = (
        FieldProblem(
            field=f"{field}.{name}",
            code="unknown-value",
            reason=f"The chart has no column '{name}'.",
            remedy=f"Its columns are {', '.join(names)}.",
        )
        for field, values in given.items()
        for name in values
        if name not in names
    )
    needed = (
        FieldProblem(
            field=f"tolerances.{name}",
            code="tolerance-needed",
            reason=f"All sizes of the chart have the same target of {name}, which does not say how "
            "far a body may be from it.",
            remedy="Give ranges, or this measurement's tolerance.",
        )
        for name in columns_without_step(chart)
        if name not in options.tolerances
    )
    return (*unknown, *needed)


class SizeChance(WireModel):
    """One size of the chart."""

    label: str
    probability: float = Field(ge=0.0, le=1.0, description="That the person takes this size.")
    cost: float = Field(description="Of the most probable body; see the request.")
    fits: bool = Field(description="Whether it fits the most probable body.")


class SizedMeasurement(WireModel):
    """What one measurement argues: for the size where it is `within`, else against it.

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
    sized_as: SizedAs
    off: float = Field(description="How far outside the range the body with its ease lies.")
    cost: float
    within: float
    too_small: float
    too_large: float
    sizes: tuple[str, ...] = Field(
        description=(
            "The sizes that this measurement alone asks for, within a standard error of its value: "
            "two of them are sizes that the person is between."
        )
    )
    remark: str = Field(description="The same in a sentence.")


class SizeResult(DerivedFiles):
    """The size, and ``sizes.csv``, the probabilities as a table.

    ``recommended`` is the most probable size, null where it is more probable that none fits.
    ``arguments`` speak of ``compared_with``: that size, or the one of least cost.
    """

    kind: Literal["size"] = "size"
    recommended: str | None
    compared_with: str
    none_fits: float = Field(ge=0.0, le=1.0, description="Probability that no size fits.")
    sizes: tuple[SizeChance, ...] = Field(
        description="In the chart's order; their probabilities and `none_fits` sum to 1."
    )
    arguments: tuple[SizedMeasurement, ...] = Field(
        description="What argues for the size and against it, in the order of the chart's columns."
    )
    warnings: tuple[FitWarning, ...]
