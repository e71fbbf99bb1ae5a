"""Which size of a chart a person takes, and how certain that is.

How badly a size fits a body in one measurement is counted in steps of the chart, the median
distance from one size to the next:

    cost = 2 max(v - high, 0) / step + max(low - v, 0) / step,    v = body + ease

The first term is of a size that is too small for the body (too tight, or too short), which counts
twice. A size *fits* where no measurement costs more than 1, and of those that fit a body takes the
one of least cost in sum; equal costs are told apart by how near the body is to the middle of the
ranges. Measurements of which a size says nothing cost nothing.

A person's body is known as a Gaussian over all measurements together. The probability of a size is
the share of bodies drawn from it that take that size.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from fitter.measurement.joint_measurements import JointMeasurements

TOO_SMALL = 2.0
"""Cost of a size that is too small, against one that is as much too large."""

LEAST_STEP = 0.1
"""Centimetres or kilograms: of a range without width in all sizes."""

BODIES = 20_000
"""Drawn from the Gaussian: probabilities err by 0.35 % at most (one standard deviation)."""

_SEED = 2009

_LARGEST_COST, _EQUAL_COST = 1.0 + 1e-9, 1e-9

BodyRange = tuple[float, float]
"""The bodies a size is made for, from the smaller to the larger."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Sizes:
    """A chart as arrays.

    Attributes
    ----------
    labels, names
        Of the sizes, and of the measurements.
    low, high
        (s, k) the bodies each size is made for; NaN where it says nothing.
    steps
        (k,) from one size to the next.
    """

    labels: tuple[str, ...]
    names: tuple[str, ...]
    low: Float[np.ndarray, "s k"]
    high: Float[np.ndarray, "s k"]
    steps: Float[np.ndarray, " k"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SizeAnswer:
    """Which size.

    Attributes
    ----------
    recommended
        The place of the most probable size; None where it is more probable that none fits.
    compared_with
        The recommended size, or that of least cost.
    none_fits
        Probability that no size fits.
    probabilities
        (s,) that a size is taken.
    """

    recommended: int | None
    compared_with: int
    none_fits: float
    probabilities: Float[np.ndarray, " s"]


def sizes_of(chart: Mapping[str, Mapping[str, BodyRange]], names: Sequence[str]) -> Sizes:
    """Put a chart into arrays, its columns in the order of ``names``."""
    nothing = (np.nan, np.nan)
    ranges = np.array([[each.get(name, nothing) for name in names] for each in chart.values()])
    return Sizes(
        labels=tuple(chart),
        names=tuple(names),
        low=ranges[..., 0],
        high=ranges[..., 1],
        steps=np.array([_step(ranges[:, column]) for column in range(len(names))]),
    )


def size_answer(sizes: Sizes, person: JointMeasurements, ease: Mapping[str, float]) -> SizeAnswer:
    """Find the size; ``ease`` is added to the body before it is compared, none where not named."""
    body = person.of(sizes.names)
    mean = body.values + [ease.get(name, 0.0) for name in sizes.names]
    bodies = np.random.default_rng(_SEED).multivariate_normal(
        mean, body.covariance, size=BODIES, method="eigh"
    )
    costs, fits, off = _compared(sizes, bodies)
    fitted = fits.any(axis=1)
    taken = _least(np.where(fits, costs, np.inf)[fitted], off[fitted])
    probabilities = np.bincount(taken, minlength=len(sizes.labels)) / BODIES
    none_fits = max(1.0 - float(probabilities.sum()), 0.0)
    cost, _, distance = _compared(sizes, mean[None])
    likeliest = int(np.argmax(probabilities))
    is_recommended = float(probabilities[likeliest]) >= none_fits
    return SizeAnswer(
        recommended=likeliest if is_recommended else None,
        compared_with=likeliest if is_recommended else int(_least(cost, distance)[0]),
        none_fits=none_fits,
        probabilities=probabilities,
    )


def _compared(
    sizes: Sizes, bodies: Float[np.ndarray, "n k"]
) -> tuple[Float[np.ndarray, "n s"], Bool[np.ndarray, "n s"], Float[np.ndarray, "n s"]]:
    """Cost of every size for every body, whether it fits, and its distance from the middle."""
    shape = len(bodies), len(sizes.labels)
    costs, fits, off = np.empty(shape), np.empty(shape, dtype=bool), np.empty(shape)
    # One size at a time: of 200 sizes and 40 measurements all costs together are gigabytes.
    for size, (low, high) in enumerate(zip(sizes.low, sizes.high, strict=True)):
        outside = TOO_SMALL * np.maximum(bodies - high, 0.0) + np.maximum(low - bodies, 0.0)
        cost = np.nan_to_num(outside / sizes.steps)
        costs[:, size] = cost.sum(axis=1)
        fits[:, size] = (cost <= _LARGEST_COST).all(axis=1)
        off[:, size] = np.nansum(np.abs(bodies - 0.5 * (low + high)) / sizes.steps, axis=1)
    return costs, fits, off


def _least(costs: Float[np.ndarray, "n s"], off: Float[np.ndarray, "n s"]) -> Int[np.ndarray, " n"]:
    """The size of least cost of each body; of several the one whose middle is nearest."""
    least = costs <= costs.min(axis=1, keepdims=True) + _EQUAL_COST
    return np.where(least, off, np.inf).argmin(axis=1)


def _step(ranges: Float[np.ndarray, "s 2"]) -> float:
    """From one size to the next; of sizes that are all alike the width of their range."""
    said = ranges[np.isfinite(ranges[:, 0])]
    middles = np.unique(said.mean(axis=1))
    if len(middles) == 1:
        return max(float((said[:, 1] - said[:, 0]).max()), LEAST_STEP)
    return max(float(np.median(middles[1:] - middles[:-1])), LEAST_STEP)
