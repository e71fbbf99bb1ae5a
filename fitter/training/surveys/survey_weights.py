"""Weights that make a model's people the survey's in stature and weight.

The models' population is wider than the survey's soldiers on purpose, so figures of the two compare
only among people of like stature and weight. Instead of drawing anew, each person is weighted.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

MAX_STEPS = 60
TOLERANCE = 1e-9
"""Of the moments, in standard deviations of the given."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Target:
    """Mean and covariance that weighted people shall have."""

    mean: Float[np.ndarray, " d"]
    covariance: Float[np.ndarray, "d d"]


class TooFewPeopleError(ValueError):
    """People who cannot stand for a survey however they are weighted."""


def matching_weights(given: Float[np.ndarray, "s d"], target: Target) -> Float[np.ndarray, " s"]:
    """Weights, summing to one, under which ``given`` have the target's mean and covariance.

    Of all such weights those nearest to equal ones in the sense of entropy: w_i ∝ exp(λ · f(x_i)),
    with f the coordinates and their products. Where the people are Gaussian these are the quotient
    of the target's density and theirs. λ minimises the convex log Σ exp λ · (f(x_i) - f̄).

    Parameters
    ----------
    given
        What is matched, such as logarithms of stature and weight, of s people.
    target
        Of the survey.

    Raises
    ------
    TooFewPeopleError
        If the people do not reach far enough to have the target's moments.
    """
    root = np.linalg.cholesky(target.covariance)
    x = np.linalg.solve(root, (given - target.mean).T).T
    first, second = np.triu_indices(x.shape[1])
    # In the target's own units its mean is zero and its covariance the identity.
    features = np.concatenate([x, x[:, first] * x[:, second] - (first == second)], axis=1)
    multipliers = np.zeros(features.shape[1])
    value, weights = _tilted(features, multipliers)
    for _ in range(MAX_STEPS):
        mean = weights @ features
        if np.abs(mean).max() < TOLERANCE:
            return weights
        curvature = (features * weights[:, None]).T @ features - np.outer(mean, mean)
        step = np.linalg.lstsq(curvature, -mean, rcond=None)[0]
        size = 1.0
        while size > TOLERANCE:
            trial = _tilted(features, multipliers + size * step)
            if trial[0] <= value + 1e-4 * size * float(mean @ step):
                break
            size *= 0.5
        multipliers = multipliers + size * step
        value, weights = _tilted(features, multipliers)
    message = f"No weights give these {len(given)} people the target's moments."
    raise TooFewPeopleError(message)


def effective_count(weights: Float[np.ndarray, " s"]) -> float:
    """How many equally weighted people say as much: (Σ w)² / Σ w²."""
    return float(weights.sum() ** 2 / (weights @ weights))


def weighted_moments(
    values: Float[np.ndarray, "s k"], weights: Float[np.ndarray, " s"]
) -> tuple[Float[np.ndarray, " k"], Float[np.ndarray, "k k"]]:
    """Mean and covariance under weights that sum to one."""
    mean = weights @ values
    offsets = values - mean
    return mean, (offsets * weights[:, None]).T @ offsets


def _tilted(
    features: Float[np.ndarray, "s f"], multipliers: Float[np.ndarray, " f"]
) -> tuple[float, Float[np.ndarray, " s"]]:
    """The convex function and its weights."""
    exponents = features @ multipliers
    largest = float(exponents.max())
    weights = np.exp(exponents - largest)
    total = float(weights.sum())
    return largest + np.log(total), weights / total
