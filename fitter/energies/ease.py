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

μ is that of the place: cloth lies on shoulders and hangs away from shins. As written, the ease of
each length Λ is independent of the others', but who wears a wide shirt wears it all over. Where the
contour is fitted to lines, all of it shares two offsets δ ~ N(0, τ_δ²), of what covers the upper
body and the legs, each in proportion f to the usual ease there. They are not parameters of the
body: the energy is that of their most probable values,

    min over δ of  Σ ρ_κ(r + μ + f · δ) c / (τ² Λ) + ½ |δ|²/τ_δ²,

so that bare skin and what is usual for people tell how wide this person's clothes are.
"""

from typing import Final

import numpy as np
from jaxtyping import Float

from fitter.energies.rows import Nuisance
from fitter.energies.scales import EnergyScales
from fitter.numerics.robust import boundary_loss, boundary_weights

Values = Float[np.ndarray, " k"]
Fullness = Float[np.ndarray, "k 2"]
"""How far what covers the upper body and the legs usually stands off, of the mean ease."""

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


def beyond_usual(residuals: Values, fullness: Fullness, scales: EnergyScales) -> Values:
    """Residuals as they would be if the mean ease were the same everywhere: r + μ - its scale."""
    return residuals + scales.ease_mean * (fullness.sum(axis=1) - 1.0)


def common_offset(
    residuals: Values, fullness: Fullness, lengths: Values, scales: EnergyScales
) -> Float[np.ndarray, "2"]:
    """The most probable δ, pixels; ``lengths`` are the pixels of outline under cloth."""
    offset = np.zeros(fullness.shape[1])
    known = np.eye(len(offset)) / scales.ease_common_spread**2
    for _ in range(_OFFSET_STEPS):
        weights = lengths * ease_weights(residuals + fullness @ offset, scales)
        weighted = fullness * weights[:, None]
        slope = weighted.T @ (residuals + scales.ease_mean)
        offset = -np.linalg.solve(weighted.T @ fullness + known, slope)
    return offset


def common_ease(
    fullness: Fullness, scales: EnergyScales, *, held_in_search: bool = False
) -> Nuisance:
    """δ as the unknowns that all rows r + μ + f · δ share."""
    return Nuisance(
        name="ease",
        slopes=fullness,
        known=np.eye(fullness.shape[1]) / scales.ease_common_spread,
        held_in_search=held_in_search,
    )
