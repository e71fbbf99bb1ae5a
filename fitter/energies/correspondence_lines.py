"""Silhouette energy E_Si by correspondence lines: how far the contour is from what they found.

A line follows the two vertices whose middle lay on the contour when it was laid out. To first order
the contour moves across itself as these do, so that the residual

    r = n · (x - c) - o

of the vertices' present middle x, the line's centre c, normal n and found offset o is where the
contour stands beside the boundary, and its derivative is exact. Lines are laid out anew as the body
moves (:mod:`fitter.optimizer.renewed_lines`).
"""

import numpy as np
from jaxtyping import Float

from fitter.energies.rows import PositionRows
from fitter.energies.scales import EnergyScales
from fitter.evidence.correspondence_lines import CorrespondenceLines
from fitter.numerics.robust import boundary_loss, boundary_weights
from fitter.render.rasterizer import Rendering


def line_energy(rendering: Rendering, lines: CorrespondenceLines, scales: EnergyScales) -> float:
    """E_Si in nats: Σ ρ(r) over the lines, each by its own variance."""
    loss = boundary_loss(_residuals(rendering, lines), scales.silhouette_eta)
    return float(_precisions(lines, scales) @ loss)


def line_rows(
    rendering: Rendering, lines: CorrespondenceLines, scales: EnergyScales
) -> PositionRows:
    """One row a line."""
    residuals = _residuals(rendering, lines)
    normals = np.repeat(lines.normals[:, None], 2, axis=1)
    ends = rendering.vertices[lines.points]
    return PositionRows(
        residuals=residuals,
        weights=_precisions(lines, scales) * boundary_weights(residuals, scales.silhouette_eta),
        points=lines.points,
        derivatives=0.5 * rendering.camera.pull_back(ends, normals),
    )


def _residuals(rendering: Rendering, lines: CorrespondenceLines) -> Float[np.ndarray, " k"]:
    moved = rendering.projected[lines.points].mean(axis=1) - lines.centres
    return np.einsum("ki,ki->k", moved, lines.normals) - lines.offsets


def _precisions(lines: CorrespondenceLines, scales: EnergyScales) -> Float[np.ndarray, " k"]:
    """What a line's squared residual costs: neighbours on the contour err alike."""
    variances = scales.contour_sigma**2 + lines.variances
    return lines.confidence * lines.spacing / (variances * scales.line_correlation_length)
