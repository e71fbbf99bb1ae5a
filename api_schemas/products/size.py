"""A size: what is asked for, and what comes of it."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from api_schemas.base import WireModel, refusal
from api_schemas.person import MeasurementName
from api_schemas.problems import FieldProblem
from api_schemas.products.base import ProductOptions, ProductResult
from api_schemas.size_chart import (
    EXAMPLE,
    MAX_CHART_BYTES,
    NOT_A_CHART,
    ChartError,
    SizeChart,
    columns_of,
    read_chart,
)


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
    """How a size fits in one measurement.

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
