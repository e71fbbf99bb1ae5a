"""What each measurement argues for a size and against it."""

from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr

from fitter.applications.size_chart import SizeChart, size_of_least_cost
from fitter.measurement.joint_measurements import JointMeasurements
from fitter.vocabulary.outcomes import SizedAs

NO_DIFFERENCE = 1e-3
"""Centimetres or kilograms: so far off the value that was given exactly a held one may lie."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SizedMeasurement:
    """What one measurement says of a size.

    Attributes
    ----------
    name, unit
        Of the measurement.
    value, standard_error
        Of the body, without ease.
    ease
        What was added to it.
    low, high
        The bodies the size is made for; None where it says nothing.
    sized_as
        How the size fits here.
    off
        How far the body with its ease lies outside the range.
    cost
        What that costs.
    within, too_small, too_large
        Probabilities that the size is made for such a body, is too small for it, too large.
    sizes
        Sizes this measurement alone asks for, within one standard error.
    says
        The same in a sentence.
    """

    name: str
    unit: str
    value: float
    standard_error: float
    ease: float
    low: float | None
    high: float | None
    sized_as: SizedAs
    off: float
    cost: float
    within: float
    too_small: float
    too_large: float
    sizes: tuple[str, ...]
    says: str


def sized_measurement(
    chart: SizeChart,
    size: int,
    column: int,
    body: JointMeasurements,
    ease: float,
    cost: float,
) -> SizedMeasurement:
    """What the measurement of a column says of a size.

    ``ease`` is added to the body, ``cost`` is what the size costs there.
    """
    eased = float(body.values[column]) + ease
    error = float(body.standard_errors[column])
    low, high = float(chart.low[size, column]), float(chart.high[size, column])
    is_said = bool(chart.is_said[size, column])
    too_small = _below(-high, -eased, error) if is_said else 0.0
    too_large = _below(low, eased, error) if is_said else 0.0
    off = max(eased - high, low - eased, 0.0) if is_said else 0.0
    if not is_said:
        sized_as = SizedAs.UNSAID
    elif off < NO_DIFFERENCE:
        sized_as = SizedAs.WITHIN
    else:
        sized_as = SizedAs.TOO_SMALL if eased > high else SizedAs.TOO_LARGE
    sizes = sizes_asked_for(chart, column, eased, error)
    unit = body.units[column]
    return SizedMeasurement(
        name=chart.names[column],
        unit=unit,
        value=float(body.values[column]),
        standard_error=error,
        ease=ease,
        low=low if is_said else None,
        high=high if is_said else None,
        sized_as=sized_as,
        off=off,
        cost=cost,
        within=max(1.0 - too_small - too_large, 0.0),
        too_small=too_small,
        too_large=too_large,
        sizes=sizes,
        says=_says(chart, size, column, body, ease, sized_as, off, sizes),
    )


def sizes_asked_for(chart: SizeChart, column: int, value: float, error: float) -> tuple[str, ...]:
    """Sizes one measurement alone asks for, somewhere within one standard error of its value.

    In the order of their ranges; sizes with the same range are all named.
    """
    rows = np.flatnonzero(chart.is_said[:, column])
    low, high = chart.low[rows, column], chart.high[rows, column]
    near = np.array([value - error, value, value + error])[:, None]
    cost = (
        np.maximum(near - high, 0.0) / chart.too_small[column]
        + np.maximum(low - near, 0.0) / chart.too_large[column]
    )
    middle = 0.5 * (low + high)
    taken = size_of_least_cost(cost, np.abs(near - middle))
    from_low, to_high = float(middle[taken].min()), float(middle[taken].max())
    order = np.argsort(middle, kind="stable").tolist()
    return tuple(
        chart.labels[int(rows[row])] for row in order if from_low <= middle[row] <= to_high
    )


def _below(bound: float, value: float, error: float) -> float:
    """Probability that a value with this error lies below a bound."""
    if error <= 0.0:
        return float(value < bound - NO_DIFFERENCE)
    return float(ndtr((bound - value) / error))


def _says(
    chart: SizeChart,
    size: int,
    column: int,
    body: JointMeasurements,
    ease: float,
    sized_as: SizedAs,
    off: float,
    sizes: tuple[str, ...],
) -> str:
    label, unit = chart.labels[size], body.units[column]
    found = f"{body.values[column] + ease:.1f} ± {body.standard_errors[column]:.1f} {unit}"
    if ease:
        found += f" with {ease:g} {unit} of ease"
    low, high = chart.low[size, column], chart.high[size, column]
    match sized_as:
        case SizedAs.UNSAID:
            where = f"of which {label} says nothing"
        case SizedAs.WITHIN:
            where = f"within {label} ({low:g} to {high:g})"
        case SizedAs.TOO_SMALL:
            where = f"{off:.1f} {unit} more than {label} is made for ({low:g} to {high:g})"
        case SizedAs.TOO_LARGE:
            where = f"{off:.1f} {unit} less than {label} is made for ({low:g} to {high:g})"
    return f"{chart.names[column]} {found}: {where}; {_asks(chart, column, sizes)}."


def _asks(chart: SizeChart, column: int, sizes: tuple[str, ...]) -> str:
    """Which sizes a measurement asks for; those with one range are alternatives to each other."""
    by_range: dict[tuple[float, float], list[str]] = {}
    for label in sizes:
        row = chart.labels.index(label)
        ends = float(chart.low[row, column]), float(chart.high[row, column])
        by_range.setdefault(ends, []).append(label)
    first, *more = (" or ".join(labels) for labels in by_range.values())
    return f"between {first} and {more[-1]}" if more else f"asks for {first}"
