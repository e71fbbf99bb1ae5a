"""What the rows of a stance say about body and camera together (:mod:`fitter.energies.stance`).

With A = √W J the rows' derivatives by the body and T = √W ∂r by pitch and roll, body and tilt as
one vector have the normal matrix

    M     AᵀT          M of everything else by the body, and AᵀA
    TᵀA   D = TᵀT

Eliminating the tilt leaves M - AᵀT D⁻¹ TᵀA (Schur), in which the stance's own part AᵀA becomes BᵀB
of the rows B = A - T D⁻¹ TᵀA. With C, the inverse of what is left, the tilt's covariance is

    D⁻¹ + D⁻¹ TᵀA C AᵀT D⁻¹.
"""

import numpy as np
from jaxtyping import Float

from fitter.body.tangent import Linearisation, linearise
from fitter.energies.fitting_operators import FittingOperators
from fitter.energies.objective import Candidate
from fitter.energies.stance import StanceRows, stance_rows
from fitter.optimizer.row_jacobians import RowJacobian, position_row_jacobian


def stance_jacobian(
    stance: StanceRows, frame: Linearisation, operators: FittingOperators, candidate: Candidate
) -> RowJacobian:
    """A of the rows of a stance."""
    return position_row_jacobian(stance.rows, frame, operators.joint_attachments, candidate.joints)


def with_free_tilt(jacobian: RowJacobian, stance: StanceRows) -> RowJacobian:
    """B of the rows of a stance."""
    by_tilt = stance.by_tilt
    return jacobian - by_tilt @ np.linalg.solve(by_tilt.T @ by_tilt, by_tilt.T @ jacobian)


def tilt_covariance(
    operators: FittingOperators,
    candidate: Candidate,
    body_covariance: Float[np.ndarray, "columns columns"],
) -> Float[np.ndarray, "2 2"]:
    """Covariance of pitch and roll, squared radians, with the body marginalised.

    ``body_covariance`` C is that of all body parameters with the tilt marginalised.
    """
    stance = stance_rows(candidate.joints, operators.stance_vectors, candidate.tilt)
    frame = linearise(operators.tangent, candidate.parameters)
    by_tilt = stance.by_tilt
    own = np.linalg.inv(by_tilt.T @ by_tilt)
    shared = own @ by_tilt.T @ stance_jacobian(stance, frame, operators, candidate)
    covariance = own + shared @ body_covariance @ shared.T
    return 0.5 * (covariance + covariance.T)
