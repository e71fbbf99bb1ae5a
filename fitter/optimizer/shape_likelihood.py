"""What one picture says about the shape, apart from what was known beforehand.

Near its minimum β̂ the energy of a picture, with pose, position and light marginalised, is a
paraboloid over the shape, ½ (β - β̂)ᵀ H (β - β̂). It includes the prior N(m, P⁻¹) and what the
caller knows about the person (residuals r with slopes S); subtracting these leaves

    ½ βᵀ Λ β - ηᵀ β,    Λ = H - P - SᵀS,    η = Λ β̂ + P (β̂ - m) + Sᵀ r,

which can be summed over pictures of one person. The height and whatever else is held do not vary:
Λ and the slopes lie in the space of what does.
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
"""Linear solves; attributes are so nearly linear that the last one changes nothing."""


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
    """The likelihood of a picture whose minimum under a prior and what is known is ``shape``.

    ``covariance`` is that of :func:`fitter.optimizer.uncertainty.shape_covariance`; the height's
    variance in it does not matter.
    """
    directions = kept_directions(attributes.held, shape)
    among_equally_tall = directions.T @ _given_height(covariance) @ directions
    before = directions.T @ (prior.precision + _information_of(attributes, shape)) @ directions
    own = np.linalg.inv(among_equally_tall) - before
    values, vectors = np.linalg.eigh(0.5 * (own + own.T))
    # A picture cannot take away from what was known.
    axes = directions @ vectors
    information = (axes * np.maximum(values, 0.0)) @ axes.T
    slope = prior.slope(shape) + _slope_of(attributes, shape)
    return ShapeLikelihood(
        information=information,
        pull=information @ shape + directions @ (directions.T @ slope),
    )


def prior_with(prior: ShapePrior, likelihoods: Sequence[ShapeLikelihood]) -> ShapePrior:
    """The prior updated with these pictures."""
    precision = prior.precision + sum(each.information for each in likelihoods)
    pull = prior.precision @ prior.mean + sum(each.pull for each in likelihoods)
    mean = prior.mean.copy()
    mean[1:] = np.linalg.solve(precision[1:, 1:], pull[1:])
    return ShapePrior(mean=mean, precision=precision)


def most_probable_shape(
    prior: ShapePrior, attributes: KnownAttributes, start: Shape
) -> tuple[Shape, Float[np.ndarray, "n n"]]:
    """The mode under a prior and what is known, as tall as ``start``, and its covariance.

    ``start`` must have what is held.
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
    """The covariance among people of the same height."""
    if covariance[0, 0] <= 0.0:
        return covariance
    return covariance - np.outer(covariance[0], covariance[0]) / covariance[0, 0]
