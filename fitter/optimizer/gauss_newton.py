"""The default optimiser: damped Gauss-Newton on E1 or E2, accepted on the true energy.

Rows from the contour, the edges, the clicks, the spheres and the shading give a 74 x 74 normal
matrix; the gradient is exact, by the reverse mode of the body. The loop is
:mod:`fitter.numerics.damped_descent`.
"""

from collections.abc import Callable
from dataclasses import dataclass

from fitter.energies.objective import Body, Candidate, EnergyObserver, Objective
from fitter.numerics.damped_descent import Offer, Step, damped_steps, descend
from fitter.optimizer.free_space import free_space
from fitter.optimizer.normal_equations import normal_equations
from fitter.optimizer.parameter_vector import limited

SETTLED_NATS = 0.05
"""A step that promises less is not tried, and two in a row that gain less end the search. A tenth
of a nat changes a likelihood by a tenth; the pixel grid at the outline makes the energy about as
rough."""

NEARLY_SETTLED_NATS = 0.2
"""The same of a search that another follows, about other evidence."""

_FLOOR = 1e-9
"""Keeps the matrix regular."""


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

        def taken(step: Step) -> Candidate | None:
            whole = limited(now.parameters, space.directions @ step)
            reached = space.moved(now.parameters, whole)
            return None if reached is None else objective.evaluate(reached)

        return damped_steps(
            space.directions.T @ matrix @ space.directions,
            gradient @ space.directions,
            taken,
            floor=_FLOOR,
        )

    found = descend(
        objective.evaluate(start),
        paraboloid,
        max_evaluations=max_evaluations,
        settled=settled_nats,
        on_accepted=lambda candidate: on_energies(candidate.energies),
    )
    return Minimum(candidate=found.point, converged=found.converged, evaluations=found.evaluations)
