"""What rows say of the body once their other unknowns are eliminated, and what of these: Schur.

With A = √W J the rows' derivatives by the body, T = √W ∂r those by their other unknowns, and P the
rows of what is known of these, body and unknowns as one vector have the normal matrix

    M     AᵀT          M of everything else by the body, and AᵀA
    TᵀA   D            D = TᵀT + PᵀP

Eliminating the unknowns leaves M - AᵀT D⁻¹ TᵀA, in which the rows' own part AᵀA becomes BᵀB of

    B = [ A - T R ]
        [   - P R ],        R = D⁻¹ TᵀA.

With C, the inverse of what is left, the unknowns' covariance is D⁻¹ + R C Rᵀ.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.energies.rows import Nuisance
from fitter.optimizer.row_jacobians import RowJacobian


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RowsWithNuisance:
    """Rows of one kind: A (k, columns), the weights (k,) and the other unknowns."""

    by_body: RowJacobian
    weights: Float[np.ndarray, " k"]
    nuisance: Nuisance

    @property
    def by_nuisance(self) -> Float[np.ndarray, "k u"]:
        """T."""
        return np.sqrt(self.weights)[:, None] * self.nuisance.slopes


def without_nuisance(kinds: Sequence[RowsWithNuisance]) -> RowJacobian:
    """B of all rows that share their other unknowns."""
    _, response = _own_and_response(kinds)
    left = [each.by_body - each.by_nuisance @ response for each in kinds]
    return np.concatenate([*left, -kinds[0].nuisance.known @ response])


def nuisance_covariance(
    rows: RowsWithNuisance, body_covariance: Float[np.ndarray, "columns columns"]
) -> Float[np.ndarray, "u u"]:
    """Covariance of the other unknowns, with the body marginalised.

    ``body_covariance`` C is that of all body parameters with these unknowns marginalised.
    """
    own, response = _own_and_response([rows])
    covariance = np.linalg.inv(own) + response @ body_covariance @ response.T
    return 0.5 * (covariance + covariance.T)


def _own_and_response(
    kinds: Sequence[RowsWithNuisance],
) -> tuple[Float[np.ndarray, "u u"], Float[np.ndarray, "u columns"]]:
    """D and R."""
    known = kinds[0].nuisance.known
    own, mixed = known.T @ known, 0.0
    for each in kinds:
        by_nuisance = each.by_nuisance
        own = own + by_nuisance.T @ by_nuisance
        mixed = mixed + by_nuisance.T @ each.by_body
    return own, np.linalg.solve(own, mixed)
