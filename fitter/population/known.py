"""Knowledge about somebody, and its fault if nobody is like that."""

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float
from scipy.special import chdtri

from fitter.errors import InvalidInputError
from fitter.population.conditional_shape import (
    ConditionedShape,
    Conditions,
    MeasuredPopulation,
    condition_shape,
)
from fitter.request import KnownMeasurement
from fitter.vocabulary.measurements import LEAST_HEIGHT_M, MOST_HEIGHT_M, STATURE

CENTIMETRES_PER_METRE = 100.0

OTHER_UNITS: Mapping[str, Sequence[tuple[float, str]]] = {
    "cm": ((100.0, "metres"), (0.1, "millimetres"), (2.54, "inches")),
    "kg": ((0.453_592, "pounds"), (6.350_29, "stones"), (0.001, "grams")),
}
"""By unit: the factors that convert a value given in another one."""

RAREST_SD = 5.0
"""One person in two million is farther from the population's mean in a measurement, and the model,
learned from a thousand people, knows nothing about such shapes. Heights are an exception: all have
one, and what an unusual one costs is told (:mod:`fitter.population.conditional_shape`)."""

_RAREST_SHARE = 5.733e-7
"""The share of people beyond that on either side; combined measurements are judged by it too."""

_LEAST_SPREAD = 0.1
"""Centimetres or kilograms: a measurement that follows from the others more closely than this is
treated as one that cannot differ at all."""


def conditioned_population(
    population: MeasuredPopulation, known: Mapping[str, KnownMeasurement]
) -> ConditionedShape:
    """The population given what is known of one of its people.

    Raises
    ------
    InvalidInputError
        ``unknown-value`` for a name that is not measured, ``out-of-range`` for a value nobody
        has, ``contradictory-measurements`` where nobody has all of them together.
    """
    for name, measurement in known.items():
        if name not in population.names:
            raise InvalidInputError(
                code="unknown-value",
                field=measurement.field_of(name),
                reason="There is no measurement of this name.",
                remedy=f"Use one of {', '.join(population.names)}.",
            )
    if STATURE in known:
        _check_stature(known[STATURE])
    conditioned = _condition(population, known)
    if _is_somebody(population, known, conditioned):
        return conditioned
    for name, measurement in known.items():
        if name != STATURE:
            _check_alone(population, known, name, measurement)
    raise _contradiction(population, known)


def _condition(
    population: MeasuredPopulation, known: Mapping[str, KnownMeasurement]
) -> ConditionedShape:
    return condition_shape(population.shapes, _conditions(population, known))


def _conditions(
    population: MeasuredPopulation, known: Mapping[str, KnownMeasurement]
) -> Conditions:
    return Conditions(
        rows=[population.names.index(name) for name in known],
        values=np.array([each.value for each in known.values()], dtype=np.float64),
        variances=np.array([each.standard_error**2 for each in known.values()], dtype=np.float64),
    )


def _is_somebody(
    population: MeasuredPopulation,
    known: Mapping[str, KnownMeasurement],
    conditioned: ConditionedShape,
) -> bool:
    """Whether people have all this together; of a given height, however unusual that is itself.

    In a Gaussian the squared distance is that of the height and that of the rest given the height.
    """
    distance, count = conditioned.squared_distance, len(known)
    if STATURE in known:
        row, stature = population.names.index(STATURE), known[STATURE]
        slope = population.shapes.jacobian_at_mean[row]
        offset = stature.value - population.shapes.mean[row]
        distance -= float(offset**2 / (slope @ slope + stature.standard_error**2))
        count -= 1
    return conditioned.met and (count == 0 or distance <= _farthest(count))


def _farthest(count: int) -> float:
    """The χ² of ``count`` measurements exceeded by as few people as exceed the limit of one."""
    return float(chdtri(count, _RAREST_SHARE)) if count else 0.0


def _check_stature(stature: KnownMeasurement) -> None:
    if not LEAST_HEIGHT_M <= stature.value / CENTIMETRES_PER_METRE <= MOST_HEIGHT_M:
        low, high = (CENTIMETRES_PER_METRE * each for each in (LEAST_HEIGHT_M, MOST_HEIGHT_M))
        reason = f"A height of {stature.value:g} cm is outside {low:g} to {high:g} cm."
        raise _out_of_range(STATURE, stature, "cm", (low, high), reason)


def _check_alone(
    population: MeasuredPopulation,
    known: Mapping[str, KnownMeasurement],
    name: str,
    measurement: KnownMeasurement,
) -> None:
    """Refuse a value that nobody has, nor anybody of the given height."""
    alone, only = population.only(name), {name: measurement}
    if _is_somebody(alone, only, _condition(alone, only)):
        return
    if STATURE in known:
        both = {STATURE: known[STATURE], **only}
        people = population.only(*both)
        if _is_somebody(people, both, _condition(people, both)):
            return
    low, high = _reach(alone)
    (unit,) = alone.units
    reason = (
        f"{measurement.value:g} {unit} is beyond what the bodies were learned from, about "
        f"{low:.0f} to {high:.0f} {unit}."
    )
    raise _out_of_range(name, measurement, unit, (low, high), reason)


def _out_of_range(
    name: str,
    measurement: KnownMeasurement,
    unit: str,
    reach: tuple[float, float],
    reason: str,
) -> InvalidInputError:
    """Say which unit the value seems to be in, if it is of the reach in another one."""
    low, high = reach
    for factor, other in OTHER_UNITS[unit]:
        if low <= measurement.value * factor <= high:
            return InvalidInputError(
                code="out-of-range",
                field=measurement.field_of(name),
                reason=f"{reason} It looks like {other}.",
                remedy=f"Send {measurement.value * factor:.4g}: this measurement is in {unit}.",
            )
    return InvalidInputError(
        code="out-of-range",
        field=measurement.field_of(name),
        reason=reason,
        remedy=f"Check the value; this measurement is in {unit}.",
    )


def _reach(alone: MeasuredPopulation) -> tuple[float, float]:
    """The measurement's values at both limits, on the most probable people there."""
    (slope,) = alone.shapes.jacobian_at_mean
    axis = RAREST_SD * slope / np.linalg.norm(slope)
    low, high = (float(alone.shapes.measure(sign * axis, [0])[0]) for sign in (-1.0, 1.0))
    return low, high


def _contradiction(
    population: MeasuredPopulation, known: Mapping[str, KnownMeasurement]
) -> InvalidInputError:
    """Name the measurement that the others contradict most, and the value they predict.

    Judged on the population linearised at its mean, where every question has an answer.
    """
    conditions = _conditions(population, known)
    slopes = population.shapes.jacobian_at_mean[conditions.rows]
    mean = population.shapes.mean[conditions.rows]
    covariance = slopes @ slopes.T + np.diag(conditions.variances)
    expectations = [
        _expected(covariance, conditions.values - mean, one) for one in range(len(mean))
    ]
    surprises = [
        abs(value - middle - expected) / spread
        for value, middle, (expected, spread) in zip(
            conditions.values, mean, expectations, strict=True
        )
    ]
    most = int(np.argmax(surprises))
    name = list(known)[most]
    expected, spread = expectations[most]
    middle = mean[most] + expected
    unit = population.units[conditions.rows[most]]
    return InvalidInputError(
        code="contradictory-measurements",
        field=known[name].field_of(name),
        reason=(
            "Nobody has all of these together: with "
            f"{', '.join(other for other in known if other != name)} as given, {name} is "
            f"expected between {middle - 2.0 * spread:.1f} and {middle + 2.0 * spread:.1f} {unit}, "
            f"and {known[name].value:g} {unit} was given."
        ),
        remedy=(
            "Check the values and how each is defined, leave out the least certain, or send "
            "them with a 'standard_error'."
        ),
    )


def _expected(
    covariance: Float[np.ndarray, "r r"], offsets: Float[np.ndarray, " r"], one: int
) -> tuple[float, float]:
    """Mean and spread of one measurement's offset, given the offsets of the others."""
    others = [row for row in range(len(offsets)) if row != one]
    weights = np.linalg.lstsq(
        covariance[np.ix_(others, others)], covariance[others, one], rcond=1e-10
    )[0]
    variance = covariance[one, one] - weights @ covariance[others, one]
    return float(weights @ offsets[others]), float(np.sqrt(max(variance, _LEAST_SPREAD**2)))
