"""Silhouette energy E_Si by correspondence lines: the contour's distance from what they found.

A line follows the two vertices whose midpoint lay on the contour when the line was placed. To first
order the contour moves along its normal as these do, so that the residual

    r = n · (x - c) - o

of the vertices' current midpoint x, the line's centre c, its normal n and the offset o found on it
is the contour's distance from the boundary, and its derivative is exact. Lines are placed anew as
the body moves (:mod:`fitter.optimizer.search`). Where the boundary is that of loose clothes,
it bounds the body from outside (:mod:`fitter.energies.ease`).
"""

import numpy as np
from jaxtyping import Float

from fitter.energies.ease import (
    beyond_usual,
    bound_share,
    common_ease,
    common_offset,
    ease_loss,
    ease_weights,
)
from fitter.energies.rows import PositionRows
from fitter.energies.scales import EnergyScales
from fitter.evidence.correspondence_lines import CorrespondenceLines
from fitter.numerics.robust import boundary_loss, boundary_weights
from fitter.render.rasterizer import Rendering


def line_energy(rendering: Rendering, lines: CorrespondenceLines, scales: EnergyScales) -> float:
    """E_Si in nats: Σ ρ(r) over the lines, each weighted by its own variance."""
    residuals = _residuals(rendering, lines)
    share = bound_share(residuals, lines.cloth)
    loss = share * boundary_loss(residuals, scales.silhouette_eta)
    return float(_precisions(lines, scales) @ loss) + _ease_energy(residuals, lines, scales)


def line_rows(
    rendering: Rendering, lines: CorrespondenceLines, scales: EnergyScales
) -> tuple[PositionRows, ...]:
    """One row per line, and another for the ease where the line shows clothes."""
    residuals = _residuals(rendering, lines)
    normals = np.repeat(lines.normals[:, None], 2, axis=1)
    ends = rendering.vertices[lines.points]
    derivatives = 0.5 * rendering.camera.pull_back(ends, normals)
    weights = _precisions(lines, scales) * boundary_weights(residuals, scales.silhouette_eta)
    bound = PositionRows(
        residuals=residuals,
        weights=bound_share(residuals, lines.cloth) * weights,
        points=lines.points,
        derivatives=derivatives,
    )
    if not lines.cloth.any():
        return (bound,)
    lengths, fullness = _cloth_lengths(lines), lines.fullness
    usual = beyond_usual(residuals, fullness, scales)
    off = usual + fullness @ common_offset(usual, fullness, lengths, scales)
    ease = PositionRows(
        residuals=off + scales.ease_mean,
        weights=lengths * ease_weights(off, scales),
        points=lines.points,
        derivatives=derivatives,
        nuisance=common_ease(fullness, scales),
    )
    return bound, ease


def _ease_energy(
    residuals: Float[np.ndarray, " k"], lines: CorrespondenceLines, scales: EnergyScales
) -> float:
    if not lines.cloth.any():
        return 0.0
    lengths, fullness = _cloth_lengths(lines), lines.fullness
    usual = beyond_usual(residuals, fullness, scales)
    offset = common_offset(usual, fullness, lengths, scales)
    prior = 0.5 * float(offset @ offset) / scales.ease_common_spread**2
    return float(lengths @ ease_loss(usual + fullness @ offset, scales)) + prior


def _residuals(rendering: Rendering, lines: CorrespondenceLines) -> Float[np.ndarray, " k"]:
    moved = rendering.projected[lines.points].mean(axis=1) - lines.centres
    return np.einsum("ki,ki->k", moved, lines.normals) - lines.offsets


def _cloth_lengths(lines: CorrespondenceLines) -> Float[np.ndarray, " k"]:
    """Pixels of contour that each line takes to be under cloth."""
    return lines.confidence * lines.spacing * lines.cloth


def _precisions(lines: CorrespondenceLines, scales: EnergyScales) -> Float[np.ndarray, " k"]:
    """Weights of the lines' squared residuals: errors of neighbours on the contour correlate."""
    variances = scales.contour_sigma**2 + lines.variances
    return lines.confidence * lines.spacing / (variances * scales.line_correlation_length)
