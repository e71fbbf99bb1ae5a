"""The default optimiser: damped Gauss-Newton on E1 or E2, accepted on the true energy.

Rows from the contour, the edges, the clicks, the spheres and the shading give a 74 x 74 normal
matrix; the gradient is exact, by the reverse mode of the body. The loop is
:mod:`fitter.optimizer.damped_descent`.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fitter.energies.objective import Body, Candidate, Objective
from fitter.optimizer.damped_descent import SETTLED_NATS, EnergyObserver, Offer, descend
from fitter.optimizer.free_space import free_space
from fitter.optimizer.normal_equations import normal_equations
from fitter.optimizer.parameter_vector import limited


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Minimum:
    """Where a search ended.

    ``converged`` is False if it ran out of evaluations; ``evaluations`` counts true energies.
    """

    candidate: Candidate
    converged: bool
    evaluations: int


def minimize_gauss_newton(
    objective: Objective,
    start: Body,
    *,
    max_evaluations: int,
    on_energies: EnergyObserver,
    settled_nats: float = SETTLED_NATS,
) -> Minimum:
    """Minimise from ``start`` until steps gain less than ``settled_nats`` or no damping helps.

    ``start`` has the attributes the objective holds.
    """

    def paraboloid(now: Candidate) -> Callable[[float], Offer[Candidate]]:
        matrix, gradient = normal_equations(objective, now)
        space = free_space(objective.attributes.held, now.parameters)
        inner = space.directions.T @ matrix @ space.directions
        pull = gradient @ space.directions
        diagonal = inner.diagonal()

        def offer(damping: float) -> Offer[Candidate]:
            damped = inner + np.diag(damping * diagonal + 1e-9)
            step = np.linalg.solve(damped, -pull)

            def taken() -> Candidate | None:
                whole = limited(now.parameters, space.directions @ step)
                reached = space.moved(now.parameters, whole)
                return None if reached is None else objective.evaluate(reached)

            return Offer(promised=-float(step @ (pull + 0.5 * inner @ step)), taken=taken)

        return offer

    found = descend(
        objective.evaluate(start),
        paraboloid,
        max_evaluations=max_evaluations,
        on_energies=on_energies,
        settled_nats=settled_nats,
    )
    return Minimum(candidate=found.point, converged=found.converged, evaluations=found.evaluations)
