"""A standard normal population of shapes, conditioned on measurements of one member.

The shape space is whitened, β ~ N(0, I), so its most probable member with measurements y taken
with variances R is the minimum of

    ½ ‖β‖² + ½ (y - m(β))ᵀ R⁻¹ (y - m(β)),

and with R = 0 the shortest β with m(β) = y. Linearised at β, with J = ∂m/∂β, both are

    β⁺ = Jᵀ (J Jᵀ + R)⁻¹ (y - m(β) + J β),    Σ = I - Jᵀ (J Jᵀ + R)⁻¹ J,

the Gauss-Newton step and the covariance of what is left open. Measurements are nearly linear in β,
so J is computed once, at the solution of the problem linearised at the mean, and held while the
residual is driven to zero; only if that does not suffice is it computed again. If many measurements
are held, some combination of them hardly changes with any shape, and the problem linearised far
away asks for shapes that nobody has: then they are held more and more tightly in steps.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from jaxtyping import Float

from fitter.arrays import Shape
from fitter.energies.shape_terms import USUAL_HEIGHT_SD, height_extrapolation
from fitter.measurement.anthropometry import (
    MeasuringBody,
    measurement_jacobian,
    measurement_values,
)
from fitter.vocabulary.measurements import STATURE
from fitter.vocabulary.remarks import Note, Remark, remark

HELD_WITHIN = 0.01
"""Centimetres or kilograms within which exactly known measurements are met: a tenth of a
millimetre, far below what a tape can tell."""

_MOST_JACOBIANS = 8
_STEPS_A_JACOBIAN = 5
_SMALLEST_STEP = 0.1

_SLACKS = (1.0, 0.3, 0.1, 0.03)
"""Standard errors, centimetres or kilograms, allowed to exact values on the way to zero. With all
eighteen measurements of 25 random men held, this way meets those of every man; in one step, of 5.
"""

_NOWHERE = 12.0
"""Standard deviations from the mean beyond which no search goes: there is nobody there."""

_SMALLEST_SHARE = 1e-10
"""Directions of J Jᵀ + R with less than this share of the largest are left out: two measurements
that say the same leave a residual instead of an infinity."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MeasuredShapes:
    """Measurements of bodies: k of them as functions of n coefficients.

    Attributes
    ----------
    measure
        Values of some of the measurements, by their rows; NaN where one cannot be taken.
    jacobian
        Of all of them by all coefficients.
    mean, jacobian_at_mean
        Both at β = 0.
    """

    measure: Callable[[Shape, Sequence[int]], Float[np.ndarray, " r"]]
    jacobian: Callable[[Shape], Float[np.ndarray, "k n"]]
    mean: Float[np.ndarray, " k"]
    jacobian_at_mean: Float[np.ndarray, "k n"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Conditions:
    """Known measurements: r of them, in their units, with their variances."""

    rows: Sequence[int]
    values: Float[np.ndarray, " r"]
    variances: Float[np.ndarray, " r"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ConditionedShape:
    """The population given the conditions.

    Attributes
    ----------
    shape
        Its most probable member β.
    covariance
        (n, n) of what the conditions leave open, Σ.
    jacobian
        (k, n) the Jacobian of all measurements that both belong to.
    met
        Whether β is the solution: exact values are met, uncertain ones balanced against the
        population.
    squared_distance
        Twice the minimum's negative log-likelihood, ‖β‖² + Σ (y - m)²/R: of people of this
        population it is distributed as χ² with r degrees of freedom.
    """

    shape: Shape
    covariance: Float[np.ndarray, "n n"]
    jacobian: Float[np.ndarray, "k n"]
    met: bool
    squared_distance: float


def condition_shape(shapes: MeasuredShapes, conditions: Conditions) -> ConditionedShape:
    """Find the most probable shape under the conditions."""
    n = shapes.jacobian_at_mean.shape[1]
    if not conditions.rows:
        return ConditionedShape(
            shape=np.zeros(n),
            covariance=np.eye(n),
            jacobian=shapes.jacobian_at_mean,
            met=True,
            squared_distance=0.0,
        )
    at_once = _conditioned(shapes, conditions, np.zeros(n), shapes.jacobian_at_mean)
    if at_once.met:
        return at_once
    shape, jacobian = np.zeros(n), shapes.jacobian_at_mean
    for slack in _SLACKS:
        eased = replace(conditions, variances=np.maximum(conditions.variances, slack**2))
        nearer = _conditioned(shapes, eased, shape, jacobian)
        if not nearer.met:
            return at_once
        shape, jacobian = nearer.shape, nearer.jacobian
    return _conditioned(shapes, conditions, shape, jacobian)


def _conditioned(
    shapes: MeasuredShapes,
    conditions: Conditions,
    start: Shape,
    jacobian: Float[np.ndarray, "k n"],
) -> ConditionedShape:
    """Solve the problem linearised at a start, then the true one from there."""
    slopes = jacobian[conditions.rows]
    gain = _gain(slopes, conditions.variances)
    found = shapes.measure(start, conditions.rows)
    shape = gain @ (conditions.values - found + slopes @ start)
    met = False
    for _ in range(_MOST_JACOBIANS):
        if not _is_somewhere(shape):
            break
        latest = shapes.jacobian(shape)
        if not np.isfinite(latest).all():
            break
        jacobian, slopes = latest, latest[conditions.rows]
        gain = _gain(slopes, conditions.variances)
        shape, found, met = _settle(shape, conditions, shapes, slopes, gain)
        if met:
            break
    return ConditionedShape(
        shape=shape,
        covariance=np.eye(jacobian.shape[1]) - gain @ slopes,
        jacobian=jacobian,
        met=met,
        squared_distance=_squared_distance(shape, conditions.values - found, conditions.variances),
    )


def _settle(
    shape: Shape,
    conditions: Conditions,
    shapes: MeasuredShapes,
    slopes: Float[np.ndarray, "r n"],
    gain: Float[np.ndarray, "n r"],
) -> tuple[Shape, Float[np.ndarray, " r"], bool]:
    """Gauss-Newton steps with the Jacobian held: the shape, its measurements, whether it is met."""
    found = shapes.measure(shape, conditions.rows)
    for _ in range(_STEPS_A_JACOBIAN):
        if not np.isfinite(found).all():
            return shape, found, False
        following = gain @ (conditions.values - found + slopes @ shape)
        moved = float(np.abs(slopes @ (following - shape)).max(initial=0.0))
        if moved < 0.5 * HELD_WITHIN:
            exact = conditions.variances == 0.0
            off = np.abs(conditions.values - found)[exact].max(initial=0.0)
            return shape, found, bool(off < HELD_WITHIN)
        if not _is_somewhere(following):
            return shape, found, False
        shape, found = _nearer(shape, following, found, conditions, shapes)
    return shape, found, False


def _nearer(
    shape: Shape,
    following: Shape,
    found: Float[np.ndarray, " r"],
    conditions: Conditions,
    shapes: MeasuredShapes,
) -> tuple[Shape, Float[np.ndarray, " r"]]:
    """The step, or as much of it as brings exact values nearer, and the measurements there.

    If nearly as much is known as there are coefficients, the whole step overshoots.
    """
    exact = conditions.variances == 0.0
    if not exact.any():
        return following, shapes.measure(following, conditions.rows)

    def distance(measured: Float[np.ndarray, " r"]) -> float:
        off = np.abs(conditions.values - measured)[exact]
        return float(np.nan_to_num(off, nan=np.inf).max())

    share = 1.0
    while True:
        reached = shape + share * (following - shape)
        measured = shapes.measure(reached, conditions.rows)
        if share < _SMALLEST_STEP or distance(measured) < distance(found):
            return reached, measured
        share *= 0.5


def _is_somewhere(shape: Shape) -> bool:
    return bool(np.linalg.norm(shape) < _NOWHERE)


def _gain(
    slopes: Float[np.ndarray, "r n"], variances: Float[np.ndarray, " r"]
) -> Float[np.ndarray, "n r"]:
    """Jᵀ (J Jᵀ + R)⁻¹, each measurement in its own standard deviations first."""
    covariance = slopes @ slopes.T + np.diag(variances)
    units = np.sqrt(np.diag(covariance))
    scaled = covariance / np.outer(units, units)
    values, vectors = np.linalg.eigh(scaled)
    kept = values > _SMALLEST_SHARE * values.max(initial=0.0)
    inverse = (vectors[:, kept] / values[kept]) @ vectors[:, kept].T
    return slopes.T @ (inverse / np.outer(units, units))


def _squared_distance(
    shape: Shape, residuals: Float[np.ndarray, " r"], variances: Float[np.ndarray, " r"]
) -> float:
    uncertain = variances > 0.0
    return float(shape @ shape + (residuals[uncertain] ** 2 / variances[uncertain]).sum())


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MeasuredPopulation:
    """A model's population and what is measured of its people.

    ``names`` and ``units`` follow the rows of ``shapes``.
    """

    body: MeasuringBody
    names: tuple[str, ...]
    units: tuple[str, ...]
    shapes: MeasuredShapes

    def only(self, *names: str) -> "MeasuredPopulation":
        """The same people, of whom nothing else is measured; in the order of the names."""
        rows = [self.names.index(name) for name in names]
        return _population(
            replace(self.body, definitions=tuple(self.body.definitions[row] for row in rows)),
            mean=self.shapes.mean[rows],
            jacobian_at_mean=self.shapes.jacobian_at_mean[rows],
        )


def measured_population(body: MeasuringBody) -> MeasuredPopulation:
    """Measure the mean person of a model; once a model."""
    mean = np.zeros(len(body.canonical.derivative))
    return _population(
        body,
        mean=measurement_values(body, mean),
        jacobian_at_mean=measurement_jacobian(body, mean),
    )


def _population(
    body: MeasuringBody,
    *,
    mean: Float[np.ndarray, " k"],
    jacobian_at_mean: Float[np.ndarray, "k n"],
) -> MeasuredPopulation:
    return MeasuredPopulation(
        body=body,
        names=tuple(definition.about.name for definition in body.definitions),
        units=tuple(definition.about.unit.value for definition in body.definitions),
        shapes=MeasuredShapes(
            measure=partial(_values_of_rows, body),
            jacobian=partial(measurement_jacobian, body),
            mean=mean,
            jacobian_at_mean=jacobian_at_mean,
        ),
    )


def _values_of_rows(
    body: MeasuringBody, shape: Shape, rows: Sequence[int]
) -> Float[np.ndarray, " r"]:
    chosen = replace(body, definitions=tuple(body.definitions[row] for row in rows))
    return measurement_values(chosen, shape)


def height_warnings(population: MeasuredPopulation, height_m: float) -> tuple[Remark, ...]:
    """Warn of a height beyond the population's usual ones, and say by how much errors are wider."""
    row = population.names.index(STATURE)
    mean = float(population.shapes.mean[row])
    deviation = float(np.linalg.norm(population.shapes.jacobian_at_mean[row]))
    stature_cm = 100.0 * height_m
    extrapolation = height_extrapolation((stature_cm - mean) / deviation)
    if extrapolation == 1.0:
        return ()
    low, high = mean - USUAL_HEIGHT_SD * deviation, mean + USUAL_HEIGHT_SD * deviation
    return (
        remark(
            Note.UNUSUAL_HEIGHT,
            f"At {stature_cm:.0f} cm the body is extrapolated: 99.7 % of the people of the "
            f"gender that bodies were learned from are {low:.0f} to {high:.0f} cm tall. "
            f"Standard errors are {np.sqrt(extrapolation):.2f} times as wide.",
        ),
    )
