"""What changed between two fits of one person, as far as it can be told.

The difference of a measurement has the variance

    s² = s₁² + s₂² - 2 r s₁ s₂

of two errors with the correlation r. Much of what two fits of one person err by is the same both
times: what a person differs in from the nearest body of the model, how a definition meets the
body, what the prior adds. How much is known of pictures of one person on one day:
:data:`fitter.person.several_pictures.SHARED_ERROR`. No more is taken to be shared, although
much more would be between two pictures taken alike, and nothing where a measurement was given. This
errs on the side of calling too little a change; and a difference is, if anything, understated,
because both fits are drawn toward the same population.

Many measurements are compared at a time. Holm's procedure (1979, Scand. J. Statist. 6:65-70) keeps
the probability that any of them is called a change without being one below
:data:`SIGNIFICANCE`, however they depend on one another.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float
from scipy.special import ndtr, ndtri

from fitter.measurement.joint_measurements import JointMeasurements
from fitter.person.several_pictures import SHARED_ERROR

SIGNIFICANCE = 0.05
"""Of all comparisons where nothing has changed, at most this share names any change."""

_EXACT = 5e-3
"""Centimetres or kilograms: two fits that were given one value exactly have it to two thousandths
(:data:`fitter.optimizer.free_space.HELD_WITHIN`, both ways)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Change:
    """How one measurement differs between two fits.

    Attributes
    ----------
    name, unit
        Of the measurement.
    before, after, difference
        In the unit; the difference is after minus before.
    standard_error
        Of the difference; zero where both were given exactly.
    shared_error
        The correlation of both errors it was computed with.
    p_value
        Probability of so large a difference where nothing changed, corrected for all measurements
        compared; None where both were given exactly, so that there is nothing to test.
    least
        The smallest difference that would be called a change, whatever the others do.
    is_change
        Whether it is called one.
    """

    name: str
    unit: str
    before: float
    after: float
    difference: float
    standard_error: float
    shared_error: float
    p_value: float | None
    least: float
    is_change: bool


def changes(before: JointMeasurements, after: JointMeasurements) -> tuple[Change, ...]:
    """Compare two fits in all measurements, which are the same ones in the same order."""
    assert before.names == after.names
    first, second = before.standard_errors, after.standard_errors
    given = np.array(
        [name in before.given or name in after.given for name in before.names], dtype=np.bool_
    )
    shared = np.where(given, 0.0, SHARED_ERROR)
    errors = np.sqrt(first**2 + second**2 - 2.0 * shared * first * second)
    differences = after.values - before.values
    tested = errors > 0.0
    p_values = np.full(len(errors), np.nan)
    p_values[tested] = holm(2.0 * ndtr(-np.abs(differences[tested]) / errors[tested]))
    called = np.where(tested, p_values < SIGNIFICANCE, np.abs(differences) > _EXACT)
    least = _least(errors, tested)
    return tuple(
        Change(
            name=name,
            unit=before.units[row],
            before=float(before.values[row]),
            after=float(after.values[row]),
            difference=float(differences[row]),
            standard_error=float(errors[row]),
            shared_error=float(shared[row]),
            p_value=float(p_values[row]) if tested[row] else None,
            least=float(least[row]),
            is_change=bool(called[row]),
        )
        for row, name in enumerate(before.names)
    )


def holm(p_values: Float[np.ndarray, " k"]) -> Float[np.ndarray, " k"]:
    """Correct p values for being k: the i-th smallest times k - i + 1, and none below a smaller."""
    order = np.argsort(p_values)
    factors = np.arange(len(p_values), 0, -1)
    corrected = np.minimum(np.maximum.accumulate(factors * p_values[order]), 1.0)
    result = np.empty_like(corrected)
    result[order] = corrected
    return result


def _least(
    errors: Float[np.ndarray, " k"], tested: Bool[np.ndarray, " k"]
) -> Float[np.ndarray, " k"]:
    """What is called a change as the only one of all."""
    count = max(int(tested.sum()), 1)
    return errors * float(-ndtri(0.5 * SIGNIFICANCE / count))


def changed(found: Sequence[Change]) -> tuple[Change, ...]:
    """Those that are called changes."""
    return tuple(each for each in found if each.is_change)
