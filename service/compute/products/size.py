"""The size of a chart that the person takes."""

import numpy as np
from scipy.special import ndtr

from api_schemas.csv_tables import models_csv
from api_schemas.products.documents import (
    SizeChance,
    SizedMeasurement,
    SizeOptions,
    SizeResult,
    columns_of,
    read_chart,
)
from fitter.applications.sizes import Sizes, size_answer, sizes_of
from fitter.measurement.joint_measurements import JointMeasurements
from service.compute.products.finished_fit import FinishedFit, Made, Report, measured
from service.jobs.inputs import CHART


def make(fit: FinishedFit, options: SizeOptions, report: Report) -> Made[SizeResult]:
    """Find the size."""
    sent = options.chart_csv
    chart = read_chart(fit.files[CHART] if sent is None else sent.encode())
    names = columns_of(chart)
    person = measured(fit, names)
    report(0.5)
    sizes = sizes_of(chart, names)
    answer = size_answer(sizes, person, options.ease)
    chances = tuple(
        SizeChance(label=label, probability=float(probability))
        for label, probability in zip(sizes.labels, answer.probabilities, strict=True)
    )
    return Made(
        result=SizeResult(
            recommended=None if answer.recommended is None else sizes.labels[answer.recommended],
            compared_with=sizes.labels[answer.compared_with],
            none_fits=answer.none_fits,
            sizes=chances,
            measurements=tuple(
                _sized(sizes, answer.compared_with, column, person.of(names), options)
                for column in range(len(names))
            ),
        ),
        files={"sizes.csv": models_csv(chances, SizeChance.model_fields)},
    )


def _sized(
    sizes: Sizes, size: int, column: int, person: JointMeasurements, options: SizeOptions
) -> SizedMeasurement:
    name = sizes.names[column]
    value, error = float(person.values[column]), float(person.standard_errors[column])
    ease = options.ease.get(name, 0.0)
    low, high = float(sizes.low[size, column]), float(sizes.high[size, column])
    is_said = np.isfinite(low)
    too_large = _below(low, value + ease, error) if is_said else 0.0
    too_small = 1.0 - _below(high, value + ease, error) if is_said else 0.0
    return SizedMeasurement(
        name=name,
        value=round(value, 2),
        unit=person.units[column],
        standard_error=round(error, 3),
        ease=ease,
        low=low if is_said else None,
        high=high if is_said else None,
        within=max(1.0 - too_small - too_large, 0.0),
        too_small=too_small,
        too_large=too_large,
    )


def _below(bound: float, value: float, error: float) -> float:
    """Probability that a value with this error lies below a bound."""
    return float(ndtr((bound - value) / error)) if error > 0.0 else float(value < bound)
