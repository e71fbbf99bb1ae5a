"""The compiled loops over correspondence lines beside the formulas as whole arrays."""

import numpy as np
import pytest
from scipy.special import ndtr

from fitter.evidence import _line_kernels as kernels

REACH = 12
INDEPENDENCE = 0.2


def coverage():
    steps = np.linspace(-kernels.BLUR, kernels.BLUR, 2 * kernels.BLUR * kernels.PLACES + 1)
    shares = ndtr(steps / 0.6)
    shares[0], shares[-1] = 0.0, 1.0
    return shares


def sides(rng, count):
    """Rows of means and covariances."""
    means = rng.uniform(0.2, 0.8, (count, 3))
    factors = 0.05 * rng.normal(size=(count, 3, 3))
    covariances = factors @ factors.swapaxes(1, 2) + 0.012**2 * np.eye(3)
    return np.hstack([means, covariances[:, *np.triu_indices(3)]])


def plain_costs(sample, inside, outside, share):
    """Negative log density of one sample that shows a share of the person."""
    covariance = np.zeros((3, 3))
    first, second = np.triu_indices(3)
    upper = share**2 * inside[3:] + (1.0 - share) ** 2 * outside[3:]
    covariance[first, second] = covariance[second, first] = upper
    away = sample - share * inside[:3] - (1.0 - share) * outside[:3]
    nats = 0.5 * away @ np.linalg.solve(covariance, away)
    nats += 0.5 * np.linalg.slogdet(2.0 * np.pi * covariance)[1]
    likely = (1.0 - kernels.ODD_SHARE) * np.exp(-nats) if nats < kernels.NEGLIGIBLE else 0.0
    return -np.log(likely + kernels.ODD_SHARE)


def plain_posterior(samples, first, last, lowest, highest, inside, outside):
    """Mean and variance over the candidate places of one line."""
    shares = coverage()
    places = np.arange(np.ceil(lowest * kernels.PLACES), np.floor(highest * kernels.PLACES) + 1.0)
    costs = np.zeros(len(places))
    for index, place in enumerate(places):
        for j in range(first, last + 1):
            depth = int(place) - (j - REACH) * kernels.PLACES + kernels.BLUR * kernels.PLACES
            share = shares[np.clip(depth, 0, len(shares) - 1)]
            costs[index] += INDEPENDENCE * plain_costs(samples[j], inside, outside, share)
    likelihood = np.exp(costs.min() - costs)
    likelihood /= likelihood.sum()
    mean = likelihood @ places / kernels.PLACES
    return mean, likelihood @ (places / kernels.PLACES - mean) ** 2


def test_posteriors_are_those_of_the_sum_over_all_samples_and_places():
    rng = np.random.default_rng(6)
    count = 24
    inside, outside = sides(rng, count), sides(rng, count)
    outside[: count // 2, :3] = inside[: count // 2, :3] + 0.1
    samples = np.where(
        np.arange(2 * REACH + 1)[:, None] < REACH + rng.integers(-4, 5, (count, 1, 1)),
        inside[:, None, :3],
        outside[:, None, :3],
    ) + 0.03 * rng.normal(size=(count, 2 * REACH + 1, 3))
    first = rng.integers(0, REACH - 2, count)
    last = rng.integers(REACH + 3, 2 * REACH + 1, count)
    lowest = np.where(first > 0, -0.5 * (REACH - first), -7.0)
    highest = np.where(last < 2 * REACH, 0.5 * (last - REACH), 7.0)
    means, variances = np.empty((2, count))
    kernels.boundary_posteriors(
        samples, first, last, lowest, highest, inside, outside, coverage(), INDEPENDENCE,
        means, variances,
    )  # fmt: skip
    plain = np.array(
        [
            plain_posterior(*each)
            for each in zip(samples, first, last, lowest, highest, inside, outside, strict=True)
        ]
    )
    assert np.ptp(plain[:, 0]) > 4.0
    np.testing.assert_allclose(means, plain[:, 0], atol=1e-8)
    np.testing.assert_allclose(variances, plain[:, 1], rtol=1e-6, atol=1e-10)


def test_lines_learn_from_near_ones_that_face_the_same_way():
    rng = np.random.default_rng(7)
    centres = rng.uniform(0.0, 300.0, (90, 2))
    angles = rng.uniform(0.0, 2.0 * np.pi, 90)
    normals = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    sums = rng.uniform(size=(90, 10))
    apart = ((centres[:, None] - centres) ** 2).sum(axis=2)
    alike = np.maximum(normals @ normals.T, 0.0)
    dense = np.exp(-0.5 * apart / 20.0**2) * alike**2
    weights, others, starts = kernels.neighbours(centres, normals, 20.0)
    assert len(weights) < 0.5 * dense.size
    np.testing.assert_allclose(
        kernels.gathered(weights, others, starts, sums), dense @ sums, rtol=1e-9
    )


@pytest.mark.parametrize("x", np.linspace(-12.0, 12.0, 25))
def test_the_series_is_the_exponential_function(x):
    assert kernels._exponential(x) == pytest.approx(np.exp(x), rel=1e-9)
