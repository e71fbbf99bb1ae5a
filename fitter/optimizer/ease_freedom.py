"""What rows of ease say about the body when all loose clothes may be wider or tighter.

Rows of ease r + μ + δ (:mod:`fitter.energies.ease`) share the offset δ ~ N(0, τ_δ²). Body and
offset as one vector have the normal matrix

    JᵀWJ    Jᵀw               J the rows' derivatives by the body, w their weights, W = diag w,
    wᵀJ     Σ w + 1/τ_δ²

and eliminating the offset leaves JᵀWJ - (Jᵀw) (Jᵀw)ᵀ / (Σ w + 1/τ_δ²) (Schur). With A = √W J and
u = √w that is BᵀB of the rows

    B = A - α u uᵀA,    α = (1 - √(1 - |u|² / (|u|² + 1/τ_δ²))) / |u|².
"""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from fitter.energies.rows import PositionRows
from fitter.energies.scales import EnergyScales
from fitter.optimizer.row_jacobians import RowJacobian


def with_free_ease(
    eases: Sequence[tuple[Float[np.ndarray, "_ columns"], PositionRows]], scales: EnergyScales
) -> RowJacobian:
    """B of all rows of ease together, each kind with its Jacobian A, (k, columns)."""
    jacobian = np.concatenate([each for each, _ in eases])
    weights = np.concatenate([rows.weights for _, rows in eases])
    roots, own = np.sqrt(weights), float(weights.sum())
    if own == 0.0:
        return jacobian
    prior = scales.ease_common_spread**-2
    share = (1.0 - np.sqrt(prior / (own + prior))) / own
    return jacobian - share * np.outer(roots, roots @ jacobian)
