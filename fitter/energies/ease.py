"""The outline of loose clothes: an outer bound on the body.

Balan and Black ("The Naked Truth", ECCV 2008): what is observed of a clothed person is the body's
boundary plus the ease e ≥ 0 of the clothes. If r is how far the body's contour lies outside the
observed outline, e = -r. Three things are known of it where cloth is seen with probability c:

- a body outside its clothes is as unlikely as one outside a tight outline: ρ_η(r)/σ² for r > 0;
- clothes stand off the body by an ease of mean μ and deviation τ:
  ρ_κ(r + μ)/τ², flat beyond κ, where a skirt or a cape says nothing of the leg beneath;
- the ease of one garment repeats itself over a length Λ.

A pixel of outline therefore costs the expected negative log-likelihood

    E(r) = (1 - c + c [r > 0]) ρ_η(r) / (σ² L) + c ρ_κ(r + μ) / (τ² Λ),

ρ_η(x) = ½ x² / (1 + x²/η²). The bracket jumps where ρ and its slope are zero, so that E is once
continuously differentiable. Its two terms are two rows of least squares; without cloth it is the
tight outline's.

As written, the ease of each length Λ is independent of the others', but a person who wears wide
clothes does so all over. Where the contour is fitted to lines, all of it shares an offset
δ ~ N(0, τ_δ²) of the mean. It is not a parameter of the body: the energy is that of its most
probable value,

    min over δ of  Σ ρ_κ(r + μ + δ) c / (τ² Λ) + ½ δ²/τ_δ²,

so that bare skin and what is usual for people tell how wide this person's clothes are.
"""

from typing import Final

import numpy as np
from jaxtyping import Float

from fitter.energies.rows import Nuisance
from fitter.energies.scales import EnergyScales
from fitter.numerics.robust import boundary_loss, boundary_weights

Values = Float[np.ndarray, " k"]

_OFFSET_STEPS: Final = 10
"""Reweighted least squares in one unknown: the last step is less than a hundredth of a pixel."""


def bound_share(residuals: Values, cloth: Values) -> Values:
    """1 - c + c [r > 0]: how much of the tight outline's cost remains."""
    return np.where(residuals > 0.0, 1.0, 1.0 - cloth)


def ease_loss(residuals: Values, scales: EnergyScales) -> Values:
    """ρ_κ(r + μ) / (τ² Λ), nats per pixel of outline that shows cloth."""
    loss = boundary_loss(residuals + scales.ease_mean, scales.ease_reach)
    return loss / (scales.ease_spread**2 * scales.ease_correlation_length)


def ease_weights(residuals: Values, scales: EnergyScales) -> Values:
    """Weights w such that w (r + μ) is the derivative of :func:`ease_loss`."""
    weights = boundary_weights(residuals + scales.ease_mean, scales.ease_reach)
    return weights / (scales.ease_spread**2 * scales.ease_correlation_length)


def common_offset(residuals: Values, lengths: Values, scales: EnergyScales) -> float:
    """The most probable δ, pixels; ``lengths`` are the pixels of outline under cloth."""
    offset = 0.0
    for _ in range(_OFFSET_STEPS):
        weights = lengths * ease_weights(residuals + offset, scales)
        precision = float(weights.sum()) + 1.0 / scales.ease_common_spread**2
        offset = -float(weights @ (residuals + scales.ease_mean)) / precision
    return offset


def common_ease(rows: int, scales: EnergyScales, *, held_in_search: bool = False) -> Nuisance:
    """δ as the unknown that so many rows r + μ + δ share."""
    return Nuisance(
        name="ease",
        slopes=np.ones((rows, 1)),
        known=np.array([[1.0 / scales.ease_common_spread]]),
        held_in_search=held_in_search,
    )
