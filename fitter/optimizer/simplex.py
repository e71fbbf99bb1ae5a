"""The paper's optimiser: a gradient-free direct search simplex on the same energy (section 3)."""

import numpy as np
from scipy.optimize import minimize

from fitter.energies.objective import Candidate, Objective
from fitter.optimizer.gauss_newton import EnergyObserver, Minimum
from fitter.optimizer.parameter_vector import free_columns, moved
from fitter.parameters import BodyParameters

# First simplex: a few degrees, centimetres and half a standard deviation along each axis.
_FIRST_TURN = 0.05
_FIRST_MOVE_M = 0.02
_FIRST_SHAPE = 0.5
_REPORT_EVERY = 50


def minimize_simplex(
    objective: Objective,
    start: BodyParameters,
    *,
    max_evaluations: int,
    on_energies: EnergyObserver,
) -> Minimum:
    """Nelder and Mead's search with coefficients adapted to the dimension (Gao and Han 2012)."""
    free = free_columns(start)
    spread = np.concatenate(
        [
            np.full(start.pose.size, _FIRST_TURN),
            np.full(3, _FIRST_MOVE_M),
            np.full(len(start.shape), _FIRST_SHAPE),
        ]
    )
    best = objective.evaluate(start)
    evaluations = 1
    on_energies(best.energies)

    def energy(step: np.ndarray) -> float:
        nonlocal best, evaluations
        whole = np.zeros(len(free))
        whole[free] = step * spread[free]
        candidate: Candidate = objective.evaluate(moved(start, whole))
        evaluations += 1
        if candidate.total < best.total:
            best = candidate
        if evaluations % _REPORT_EVERY == 0:
            on_energies(best.energies)
        return candidate.total

    dimension = int(np.count_nonzero(free))
    corners = np.vstack([np.zeros(dimension), np.eye(dimension)])
    outcome = minimize(
        energy,
        np.zeros(dimension),
        method="Nelder-Mead",
        options={
            "initial_simplex": corners,
            "adaptive": True,
            "maxfev": max_evaluations - 1,
            "maxiter": max_evaluations,
            "fatol": 1e-3,
            "xatol": 1e-3,
        },
    )
    on_energies(best.energies)
    return Minimum(candidate=best, converged=bool(outcome.success), evaluations=evaluations)
