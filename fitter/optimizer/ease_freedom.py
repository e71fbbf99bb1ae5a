"""What the outline no longer says of the body once all loose clothes may be wider or tighter.

Rows of ease r + μ (:mod:`fitter.energies.ease`) differ along the outline by the deviation τ, as if
each length Λ of it were another garment. A person who dresses widely does so all over: with one
offset δ ~ N(0, τ²) that every row shares, r + μ + δ, body and offset as one vector have the normal
matrix

    M    Jᵀw              J the rows' derivatives by the body, w their weights,
    wᵀJ  Σ w + 1/τ²

and marginalising the offset leaves M - (Jᵀw) (Jᵀw)ᵀ / (Σ w + 1/τ²) (Schur).
"""

import numpy as np
from jaxtyping import Float

from fitter.body.tangent import linearise
from fitter.energies.objective import Candidate, Objective
from fitter.energies.rows import thinned
from fitter.optimizer.normal_equations import MATRIX_ROWS, outline_rows
from fitter.optimizer.row_jacobians import position_row_jacobian


def information_lost_to_ease(
    objective: Objective, candidate: Candidate
) -> Float[np.ndarray, "columns columns"]:
    """(Jᵀw) (Jᵀw)ᵀ / (Σ w + 1/τ²) over the full parameter vector, in nats.

    The rows are those of the normal equations, so that the difference stays positive semidefinite.
    Zero where no cloth is seen along the outline.
    """
    instruments = objective.instruments
    frame = linearise(instruments.tangent, candidate.parameters)
    mixed = np.zeros(candidate.parameters.pose.size + 3 + candidate.parameters.shape.size)
    own = 1.0 / objective.scales.ease_spread**2
    for rows in outline_rows(objective, candidate):
        if not rows.of_ease:
            continue
        few = thinned(rows, MATRIX_ROWS)
        vertices = instruments.tangent.vertices
        body = position_row_jacobian(few, frame, vertices, candidate.vertices)
        mixed += np.sqrt(few.weights) @ body
        own += float(few.weights.sum())
    return np.outer(mixed, mixed) / own
