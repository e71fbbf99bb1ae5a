"""The default optimiser: damped Gauss-Newton on E1 or E2, accepted on the true energy.

Rows from the contour, the edges, the clicks, the spheres and the shading give a 74 x 74 normal
matrix of each picture; the gradient is exact, by the reverse mode of the body. Pictures meet in the
shape (:mod:`fitter.optimizer.joint_equations`). The loop is :mod:`fitter.numerics.damped_descent`.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from fitter.energies.joint_objective import JointCandidate, JointObjective
from fitter.energies.objective import Body, EnergyObserver
from fitter.numerics.damped_descent import Offer, descend
from fitter.optimizer.free_space import excess, free_space
from fitter.optimizer.joint_equations import joint_equations

SETTLED_NATS = 0.05
"""A step that promises less is not tried, and two in a row that gain less end the search. A tenth
of a nat changes a likelihood by a tenth; the pixel grid at the outline makes the energy about as
rough."""

NEARLY_SETTLED_NATS = 0.2
"""The same of a search that another follows, about other evidence."""

FIRMLY_SETTLED_NATS = 0.02
"""The same of the last search. So far above the minimum a measurement is a fifth of its standard
error off, √(2 · 0.02), where it would be a third at 0.05: pictures that differ by what nobody sees
would end apart by as much."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Minimum:
    """End of a search.

    ``converged`` is False if it ran out of evaluations; ``evaluations`` counts true energies, of
    all pictures together.
    """

    candidate: JointCandidate
    converged: bool
    evaluations: int


def minimize_gauss_newton(
    objective: JointObjective,
    start: Sequence[Body],
    *,
    max_evaluations: int,
    on_energies: EnergyObserver,
    settled_nats: float = SETTLED_NATS,
) -> Minimum:
    """Minimise from ``start`` until steps gain less than ``settled_nats`` or no damping helps.

    ``start`` holds a body for each picture, all of one shape that has what the objective holds.
    """

    def paraboloid(now: JointCandidate) -> Callable[[float], Offer[JointCandidate]]:
        space = free_space(objective.attributes.held, now.shape)
        equations = joint_equations(objective, now, space)

        def offer(damping: float) -> Offer[JointCandidate]:
            step = equations.step(damping)

            def taken() -> JointCandidate | None:
                change = space.directions @ step.shape
                longest = max(
                    excess(body, np.concatenate([own, change]))
                    for body, own in zip(now.bodies, step.own, strict=True)
                )
                share = 1.0 / max(longest, 1.0)
                reached = space.moved(now.bodies, [share * own for own in step.own], share * change)
                return None if reached is None else objective.evaluate(reached)

            return Offer(promised=step.promised, taken=taken)

        return offer

    found = descend(
        objective.evaluate(start),
        paraboloid,
        max_evaluations=max_evaluations,
        settled=settled_nats,
        on_accepted=lambda candidate: on_energies(candidate.energies),
    )
    return Minimum(candidate=found.point, converged=found.converged, evaluations=found.evaluations)
