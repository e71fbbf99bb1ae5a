"""Mixtures of five Gaussians in RGB: the colours of the person and of the background.

Reference [18], section 3.1: Rother, Kolmogorov and Blake, "GrabCut", SIGGRAPH 2004.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Float32, UInt8

from fitter.segmentation._mixture_kernels import (
    component_sums,
    likeliest_components,
    mixture_costs,
)

COMPONENTS = 5
"""GrabCut's."""

LLOYD_ITERATIONS = 10
"""The centres only initialise the mixtures, which are learnt again with every cut."""

ROUNDING_VARIANCE = 1.0 / 12.0
"""Variance of rounding to one of 255 steps; keeps a component of a single colour, such as a clipped
sky, from having none."""

Colours = Float32[np.ndarray, "s 3"]
"""In steps of 8-bit display values, 0 to 255."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ColourMixture:
    """Gaussians in RGB, in steps of 8-bit values.

    Attributes
    ----------
    weights
        (k,) positive shares that sum to 1.
    means
        (k, 3).
    covariances
        (k, 3, 3).
    """

    weights: Float[np.ndarray, " k"]
    means: Float[np.ndarray, "k 3"]
    covariances: Float[np.ndarray, "k 3 3"]

    def costs(self, colours: Colours) -> Float32[np.ndarray, " s"]:
        """Negative log density, up to a constant that is the same for all mixtures."""
        return mixture_costs(colours, _components(self))


def first_mixture(colours: Colours) -> ColourMixture:
    """The mixture of k-means clusters.

    The initial centres are deterministic: the cluster with the largest spread in any direction is
    split across that direction at its mean, until there are five (Orchard and Bouman 1991); k-means
    then moves them.

    Parameters
    ----------
    colours
        At least one.
    """
    chosen = np.zeros(len(colours), dtype=np.uint8)
    mixture = _learnt(colours, chosen)
    for added in range(1, COMPONENTS):
        spreads, directions = np.linalg.eigh(mixture.covariances)
        widest = int(np.argmax(spreads[:, -1]))
        direction, mean = directions[widest, :, -1], mixture.means[widest]
        beyond = (colours - mean) @ direction > 0.0
        chosen[(chosen == widest) & beyond] = added
        if len(np.unique(chosen)) <= added:
            break  # No more colours than components.
        mixture = _learnt(colours, chosen)
    for _ in range(LLOYD_ITERATIONS):
        chosen = likeliest_components(colours, _round_components(mixture.means))
        mixture = _learnt(colours, chosen)
    return mixture


def relearnt_mixture(mixture: ColourMixture, colours: Colours) -> ColourMixture:
    """Assign each colour to its likeliest component, and learn the components again.

    Parameters
    ----------
    colours
        At least one. A component that is not the likeliest for any of them is dropped.
    """
    return _learnt(colours, likeliest_components(colours, _components(mixture)))


def _learnt(colours: Colours, chosen: UInt8[np.ndarray, " s"]) -> ColourMixture:
    sums = component_sums(colours, chosen, COMPONENTS)
    sums = sums[sums[:, 0] > 0.0]
    moments = sums[:, 1:] / sums[:, :1]
    means = moments[:, :3]
    squares = moments[:, [3, 4, 5, 4, 6, 7, 5, 7, 8]].reshape(-1, 3, 3)
    covariances = squares - means[:, :, None] * means[:, None, :]
    return ColourMixture(
        weights=sums[:, 0] / sums[:, 0].sum(),
        means=means,
        covariances=covariances + ROUNDING_VARIANCE * np.eye(3),
    )


def _components(mixture: ColourMixture) -> Float32[np.ndarray, "k 10"]:
    """The rows the kernels read."""
    factors = np.linalg.cholesky(np.linalg.inv(mixture.covariances)).swapaxes(1, 2)
    offsets = -np.log(mixture.weights) + 0.5 * np.linalg.slogdet(mixture.covariances)[1]
    upper = factors[:, *np.triu_indices(3)]
    return np.column_stack([offsets, mixture.means, upper]).astype(np.float32)


def _round_components(means: Float[np.ndarray, "k 3"]) -> Float32[np.ndarray, "k 10"]:
    """Equal components around the means, so that the likeliest is the nearest."""
    rows = np.zeros((len(means), 10), dtype=np.float32)
    rows[:, 1:4] = means
    rows[:, [4, 7, 9]] = 1.0
    return rows
