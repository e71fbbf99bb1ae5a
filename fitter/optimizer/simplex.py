"""The paper's optimiser: Nelder and Mead's simplex search on the same energy (section 3)."""

from collections.abc import Sequence

import numpy as np

from fitter.energies.joint_objective import JointObjective
from fitter.energies.objective import Body, EnergyObserver
from fitter.optimizer.free_space import free_space
from fitter.optimizer.gauss_newton import Minimum

# First simplex: a few degrees, centimetres and half a standard deviation along each axis.
_FIRST_TURN = 0.05
_FIRST_MOVE_M = 0.02
_FIRST_SHAPE = 0.5
_REPORT_EVERY = 50


def minimize_simplex(
    objective: JointObjective,
    start: Sequence[Body],
    *,
    max_evaluations: int,
    on_energies: EnergyObserver,
) -> Minimum:
    """Nelder and Mead's search with coefficients adapted to the dimension (Gao and Han 2012).

    ``start`` holds a body for each picture, as in :func:`minimize_gauss_newton`.
    """
    best = objective.evaluate(start)
    first = best.bodies
    space = free_space(objective.attributes.held, best.shape)
    spread = np.concatenate([np.full(first[0].pose.size, _FIRST_TURN), np.full(3, _FIRST_MOVE_M)])
    evaluations = 1
    on_energies(best.energies)

    def energy(step: np.ndarray) -> float:
        nonlocal best, evaluations
        *own, shape = np.split(step, len(spread) * np.arange(1, len(first) + 1))
        # The spread is the same for all shape coefficients, since the directions mix them.
        change = _FIRST_SHAPE * (space.directions @ shape)
        reached = space.moved(first, [spread * each for each in own], change)
        evaluations += 1
        if reached is None:
            return np.inf
        candidate = objective.evaluate(reached)
        if candidate.total < best.total:
            best = candidate
        if evaluations % _REPORT_EVERY == 0:
            on_energies(best.energies)
        return candidate.total

    # Loaded by those who ask for it: three megabytes, and a tenth of a second.
    from scipy.optimize import minimize

    dimension = len(first) * len(spread) + space.directions.shape[1]
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
