"""Errors of measurements from pictures on people who were measured with a tape.

People, not pictures, are the sample: what several pictures of one person say is first averaged over
them, and intervals are bootstrapped over persons (Efron, 1979).
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.stats import bootstrap

from fitter.measurement.definitions import INTERVAL_SD

RESAMPLES: Final = 9_999
SEED: Final = 2009
_FEWEST_PEOPLE: Final = 2


@dataclass(frozen=True, slots=True, kw_only=True)
class Pair:
    """A measurement of one person, from a picture and by tape, in the same unit.

    ``again`` is a second reading of the tape; ``standard_error`` is what the fit says of itself.
    """

    person: str
    found: float
    standard_error: float | None
    tape: float
    again: float | None = None

    @property
    def error(self) -> float:
        """Found minus true; the truth is the mean of the readings."""
        truth = self.tape if self.again is None else 0.5 * (self.tape + self.again)
        return self.found - truth


@dataclass(frozen=True, slots=True, kw_only=True)
class Estimate:
    """A mean over people, and between what 95 % of resampled means lie; None for one person."""

    value: float
    low: float | None
    high: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class ErrorFigures:
    """Errors of one measurement.

    Attributes
    ----------
    people, pictures
        How many.
    mean_absolute, bias
        Of the errors, in the measurement's unit.
    held
        Share of the 95 % intervals that hold the tape's value; None where no fit had a standard
        error.
    half_width
        The median half width of these intervals.
    repeatability
        Standard deviation of what pictures of one person say; None without repeated pictures.
    tape_error
        The technical error of measurement of the tape, √(Σ d² / 2n) over n pairs of readings; None
        without second readings.
    """

    people: int
    pictures: int
    mean_absolute: Estimate
    bias: Estimate
    held: Estimate | None
    half_width: float | None
    repeatability: float | None
    tape_error: float | None


def error_figures(pairs: Sequence[Pair]) -> ErrorFigures:
    """Compare what was found with the tape; ``pairs`` are of one measurement, one at least."""
    by_person = _by_person(pairs)
    sure = [each for each in pairs if each.standard_error is not None]
    margins = [_margin(each) for each in sure]
    within = [
        [float(abs(each.error) <= _margin(each)) for each in group]
        for group in _by_person(sure).values()
    ]
    return ErrorFigures(
        people=len(by_person),
        pictures=len(pairs),
        mean_absolute=_over_people([[abs(p.error) for p in g] for g in by_person.values()]),
        bias=_over_people([[p.error for p in g] for g in by_person.values()]),
        held=_over_people(within) if within else None,
        half_width=float(np.median(margins)) if margins else None,
        repeatability=_within_people([[p.found for p in g] for g in by_person.values()]),
        tape_error=_tape_error(by_person),
    )


def mean_absolute(errors_by_person: Iterable[Sequence[float]]) -> Estimate:
    """The mean absolute error of something else on the same people, with its interval."""
    return _over_people([np.abs(errors).tolist() for errors in errors_by_person])


def _margin(pair: Pair) -> float:
    assert pair.standard_error is not None
    return INTERVAL_SD * pair.standard_error


def _by_person(pairs: Iterable[Pair]) -> dict[str, list[Pair]]:
    found: dict[str, list[Pair]] = {}
    for each in pairs:
        found.setdefault(each.person, []).append(each)
    return found


def _over_people(values: Sequence[Sequence[float]]) -> Estimate:
    means = np.array([np.mean(each) for each in values])
    if len(means) < _FEWEST_PEOPLE:
        return Estimate(value=float(means.mean()), low=None, high=None)
    interval = bootstrap(
        (means,), np.mean, n_resamples=RESAMPLES, method="percentile", rng=SEED
    ).confidence_interval
    return Estimate(value=float(means.mean()), low=float(interval.low), high=float(interval.high))


def _within_people(values: Sequence[Sequence[float]]) -> float | None:
    """Pooled over people: the root of the summed squares by their degrees of freedom."""
    repeated = [np.asarray(each) for each in values if len(each) > 1]
    if not repeated:
        return None
    squares = sum(float(((each - each.mean()) ** 2).sum()) for each in repeated)
    return float(np.sqrt(squares / sum(len(each) - 1 for each in repeated)))


def _tape_error(by_person: dict[str, list[Pair]]) -> float | None:
    """Error of the readings of each person, once, whichever picture they are written beside."""
    differences = [
        group[0].tape - group[0].again for group in by_person.values() if group[0].again is not None
    ]
    if not differences:
        return None
    return float(np.sqrt(np.mean(np.square(differences)) / 2.0))
