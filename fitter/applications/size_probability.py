"""Which size of a chart a person takes, and how certain that is.

Of a body that is known exactly the size is that of least cost, the sum over the measurements of
:func:`fitter.applications.size_chart.costs`, among those sizes that fit, that is, where no
measurement costs more than 1; equal costs are told apart by how near the body is to the middle of
the ranges. Where no size fits there is none. A person's body is known as a Gaussian over all
measurements together, and the probability of a size is the share of this Gaussian that takes it, so
that the sizes' probabilities and that of none sum to 1.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float
from scipy.special import ndtri
from scipy.stats import qmc

from fitter.applications.size_arguments import SizedMeasurement, sized_measurement
from fitter.applications.size_chart import SizeChart, costs, off_centre, size_of_least_cost
from fitter.measurement.joint_measurements import JointMeasurements

POINTS_POWER = 13
"""8,192 points: of three to eight measurements probabilities err by 0.003 at most."""

_LARGEST_COST = 1.0 + 1e-9


@dataclass(frozen=True, slots=True, kw_only=True)
class SizeChance:
    """One size of the chart.

    Attributes
    ----------
    label
        Its name.
    probability
        That it is the one the person takes.
    cost
        Of the most probable body.
    fits
        Whether it fits that body.
    """

    label: str
    probability: float
    cost: float
    fits: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class SizeAnswer:
    """Which size.

    Attributes
    ----------
    recommended
        The most probable size; None where it is more probable that none fits.
    compared_with
        The size that ``measurements`` speak of: the recommended one, or that of least cost.
    none_fits
        Probability that no size fits.
    sizes
        In the order of the chart.
    measurements
        In the order of the chart's columns: what argues for the size and what against it.
    """

    recommended: str | None
    compared_with: str
    none_fits: float
    sizes: tuple[SizeChance, ...]
    measurements: tuple[SizedMeasurement, ...]


def size_answer(
    chart: SizeChart, person: JointMeasurements, ease: Mapping[str, float]
) -> SizeAnswer:
    """Find the size; ``ease`` is added to the body before it is compared, none where not named."""
    body = person.of(chart.names)
    eases = [ease.get(name, 0.0) for name in chart.names]
    eased = body.values + np.array(eases)
    points = gaussian_points(eased, body.covariance, power=POINTS_POWER)
    shares = _shares(chart, points)
    at_best = costs(chart, eased)
    sums, fits = at_best.sum(axis=1), _fitting(at_best)
    # Where nothing fits, the size of least cost is still the one to speak of.
    nearest = int(size_of_least_cost(sums[None], off_centre(chart, eased).sum(axis=1)[None])[0])
    none_fits = max(1.0 - float(shares.sum()), 0.0)
    likeliest = int(np.argmax(shares))
    is_recommended = float(shares[likeliest]) >= none_fits
    spoken_of = likeliest if is_recommended else nearest
    return SizeAnswer(
        recommended=chart.labels[likeliest] if is_recommended else None,
        compared_with=chart.labels[spoken_of],
        none_fits=none_fits,
        sizes=tuple(
            SizeChance(label=label, probability=float(share), cost=float(cost), fits=bool(fit))
            for label, share, cost, fit in zip(chart.labels, shares, sums, fits, strict=True)
        ),
        measurements=tuple(
            sized_measurement(chart, spoken_of, column, body, eases[column], float(cost))
            for column, cost in enumerate(at_best[spoken_of])
        ),
    )


def _shares(chart: SizeChart, points: Float[np.ndarray, "n k"]) -> Float[np.ndarray, " s"]:
    """Of equally probable bodies, the share that takes each size."""
    # One size at a time: of 200 sizes and 40 measurements all costs together are half a gigabyte.
    sums = np.empty((len(points), len(chart.labels)))
    distances = np.empty_like(sums)
    for size in range(len(chart.labels)):
        alone = _only(chart, size)
        cost = costs(alone, points)
        sums[:, size] = np.where(_fitting(cost), cost.sum(axis=-1), np.inf)[:, 0]
        distances[:, size] = off_centre(alone, points).sum(axis=-1)[:, 0]
    fitted = np.isfinite(sums).any(axis=1)
    taken = size_of_least_cost(sums[fitted], distances[fitted])
    return np.bincount(taken, minlength=len(chart.labels)) / len(points)


def _only(chart: SizeChart, size: int) -> SizeChart:
    return SizeChart(
        labels=chart.labels[size : size + 1],
        names=chart.names,
        low=chart.low[size : size + 1],
        high=chart.high[size : size + 1],
        too_small=chart.too_small,
        too_large=chart.too_large,
    )


def _fitting(cost: Float[np.ndarray, "*n s k"]) -> Bool[np.ndarray, "*n s"]:
    return np.all(cost <= _LARGEST_COST, axis=-1)


_NO_VARIANCE = 1e-12
"""Of the largest variance: directions that vary less do not vary."""


def gaussian_points(
    mean: Float[np.ndarray, " k"], covariance: Float[np.ndarray, "k k"], *, power: int
) -> Float[np.ndarray, "n k"]:
    """2 ** ``power`` points of a Gaussian, each as probable as any other.

    A Sobol sequence, moved into the middle of its cells and taken through the normal quantiles,
    whose first axes go along the directions of largest variance. In one dimension the points are
    the quantiles of the middles of n equal shares.
    """
    variances, directions = np.linalg.eigh(covariance)
    varying = variances > _NO_VARIANCE * max(float(variances[-1]), 0.0)
    spread = directions[:, varying] * np.sqrt(variances[varying])
    count = 2**power
    if not varying.any():
        return np.tile(mean, (count, 1))
    uniform = qmc.Sobol(spread.shape[1], scramble=False).random_base2(power) + 0.5 / count
    return mean + ndtri(uniform) @ spread[:, ::-1].T
