"""The size of a chart that the person takes."""

from collections.abc import Callable, Mapping

from api_schemas.derivation_kinds.size import (
    SizeChance,
    SizedMeasurement,
    SizeOptions,
    SizeResult,
    SizeTolerance,
)
from api_schemas.results import FitWarning
from api_schemas.size_chart_csv import read_chart
from api_schemas.size_charts import BodyRange, SizeChart
from fitter.applications import size_arguments
from fitter.applications import size_chart as charts
from fitter.applications.size_probability import SizeAnswer, size_answer
from service.jobs.inputs import CHART
from service.representation.csv_tables import models_csv
from service.worker.derived.measured import measured_person
from service.worker.pipeline_port import DerivationInput, DerivationOutput


def derive(
    job: DerivationInput[SizeOptions], observe: Callable[[float], None]
) -> DerivationOutput[SizeResult]:
    """Find the size; see :class:`service.worker.derivers.Deriver`."""
    options = job.options
    measured = measured_person(job.inputs, job.models, field="kind").measured
    observe(0.5)
    sent = options.sent_chart
    chart = _chart(read_chart(job.inputs[CHART]) if sent is None else sent, options.tolerances)
    answer = size_answer(chart, measured, options.ease)
    sizes = tuple(
        SizeChance(label=each.label, probability=each.probability, cost=each.cost, fits=each.fits)
        for each in answer.sizes
    )
    return DerivationOutput(
        result=SizeResult(
            recommended=answer.recommended,
            compared_with=answer.compared_with,
            none_fits=answer.none_fits,
            sizes=sizes,
            arguments=_arguments(answer),
            warnings=tuple(
                FitWarning(code=each.code, message=each.message)
                for each in charts.chart_remarks(chart, measured.of(chart.names).units)
            ),
            files=(),
        ),
        files={"sizes.csv": models_csv(sizes, SizeChance.model_fields)},
    )


def _chart(sent: SizeChart, tolerances: Mapping[str, SizeTolerance]) -> charts.SizeChart:
    return charts.size_chart(
        {
            size.label: {
                name: (value.low, value.high) if isinstance(value, BodyRange) else value
                for name, value in size.measurements.items()
            }
            for size in sent.sizes
        },
        {
            name: charts.Tolerance(too_small=each.too_small, too_large=each.too_large)
            for name, each in tolerances.items()
        },
    )


def _arguments(answer: SizeAnswer) -> tuple[SizedMeasurement, ...]:
    return tuple(_argument(each) for each in answer.measurements)


def _argument(said: size_arguments.SizedMeasurement) -> SizedMeasurement:
    return SizedMeasurement(
        name=said.name,
        value=round(said.value, 2),
        unit=said.unit,
        standard_error=round(said.standard_error, 3),
        ease=said.ease,
        low=said.low,
        high=said.high,
        sized_as=said.sized_as,
        off=said.off,
        cost=said.cost,
        within=said.within,
        too_small=said.too_small,
        too_large=said.too_large,
        sizes=said.sizes,
        remark=said.says,
    )
