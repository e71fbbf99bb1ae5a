"""What one picture says of the shape, apart from what was known before it was looked at.

Near its minimum β̂ the energy of a picture, with pose, place and light marginalised, is a
paraboloid over the shape, ½ (β - β̂)ᵀ H (β - β̂). The prior N(m, P⁻¹), and what the caller knows of
the person (residuals r with slopes S), are a part of it; taken away they leave

    ½ βᵀ Λ β - ηᵀ β,    Λ = H - P - SᵀS,    η = Λ β̂ + P (β̂ - m) + Sᵀ r,

which pictures of one person add up. The height, and what else is held, does not vary: Λ and the
slopes lie in the space of what does.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import Shape
from fitter.energies.attributes import KnownAttributes, attribute_residuals, attribute_slopes
from fitter.energies.priors import ShapePrior
from fitter.optimizer.free_space import held_shape, kept_directions

_STEPS = 3
"""Attributes bend little: of so many linear solves the last changes nothing."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ShapeLikelihood:
    """A paraboloid over the shape, nats.

    Attributes
    ----------
    information
        (n, n) Λ.
    pull
        (n,) η.
    """

    information: Float[np.ndarray, "n n"]
    pull: Shape


def shape_likelihood(
    shape: Shape,
    covariance: Float[np.ndarray, "n n"],
    *,
    prior: ShapePrior,
    attributes: KnownAttributes,
) -> ShapeLikelihood:
    """Of a picture whose minimum lies at ``shape``, under a prior and what is known.

    ``covariance`` is :func:`fitter.optimizer.uncertainty.shape_covariance`; how uncertain the
    height is does not matter.
    """
    directions = kept_directions(attributes.held, shape)
    among_equally_tall = directions.T @ _given_height(covariance) @ directions
    before = directions.T @ (prior.precision + _information_of(attributes, shape)) @ directions
    own = np.linalg.inv(among_equally_tall) - before
    values, vectors = np.linalg.eigh(0.5 * (own + own.T))
    # A picture takes nothing away from what was known.
    axes = directions @ vectors
    information = (axes * np.maximum(values, 0.0)) @ axes.T
    slope = prior.slope(shape) + _slope_of(attributes, shape)
    return ShapeLikelihood(
        information=information,
        pull=information @ shape + directions @ (directions.T @ slope),
    )


def prior_with(prior: ShapePrior, likelihoods: Sequence[ShapeLikelihood]) -> ShapePrior:
    """The prior once these pictures are known too."""
    precision = prior.precision + sum(each.information for each in likelihoods)
    pull = prior.precision @ prior.mean + sum(each.pull for each in likelihoods)
    mean = prior.mean.copy()
    mean[1:] = np.linalg.solve(precision[1:, 1:], pull[1:])
    return ShapePrior(mean=mean, precision=precision)


def most_probable_shape(
    prior: ShapePrior, attributes: KnownAttributes, start: Shape
) -> tuple[Shape, Float[np.ndarray, "n n"]]:
    """The mode of a prior and what is known, as tall as ``start``, and its covariance.

    ``start`` has what is held.
    """
    shape, covariance = start, np.zeros_like(prior.precision)
    for _ in range(_STEPS):
        directions = kept_directions(attributes.held, shape)
        matrix = prior.precision + _information_of(attributes, shape)
        slope = prior.slope(shape) + _slope_of(attributes, shape)
        covariance = directions @ np.linalg.inv(directions.T @ matrix @ directions) @ directions.T
        shape = held_shape(attributes.held, shape - covariance @ slope)
    return shape, covariance


def _information_of(attributes: KnownAttributes, shape: Shape) -> Float[np.ndarray, "n n"]:
    slopes = attribute_slopes(attributes, shape)
    return slopes.T @ slopes


def _slope_of(attributes: KnownAttributes, shape: Shape) -> Shape:
    return attribute_slopes(attributes, shape).T @ attribute_residuals(attributes, shape)


def _given_height(covariance: Float[np.ndarray, "n n"]) -> Float[np.ndarray, "n n"]:
    """The covariance among people of one height."""
    if covariance[0, 0] <= 0.0:
        return covariance
    return covariance - np.outer(covariance[0], covariance[0]) / covariance[0, 0]
