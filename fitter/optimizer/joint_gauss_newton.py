"""Gauss-Newton on the energy of one person in several pictures."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fitter.energies.joint_objective import JointCandidate, JointObjective
from fitter.energies.objective import Body, EnergyObserver
from fitter.numerics.damped_descent import Offer, descend
from fitter.optimizer.free_space import free_space
from fitter.optimizer.gauss_newton import SETTLED_NATS
from fitter.optimizer.joint_equations import joint_equations
from fitter.optimizer.parameter_vector import excess, moved


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class JointMinimum:
    """Where a search ended.

    ``converged`` is False if it ran out of evaluations, of which each counts all pictures once.
    """

    candidate: JointCandidate
    converged: bool
    evaluations: int


def minimize_jointly(
    objective: JointObjective,
    start: Sequence[Body],
    *,
    max_evaluations: int,
    on_energies: EnergyObserver,
    settled_nats: float = SETTLED_NATS,
) -> JointMinimum:
    """Minimise over one shape and the pose and place in each picture.

    ``start`` holds a body for each picture, all of one shape that has what the objective holds.
    """

    def paraboloid(now: JointCandidate) -> Callable[[float], Offer[JointCandidate]]:
        equations = joint_equations(objective, now)
        space = free_space(objective.attributes.held, now.bodies[0])

        def offer(damping: float) -> Offer[JointCandidate]:
            step = equations.step(damping)
            change = equations.directions @ step.shape
            steps = [np.concatenate([own, change]) for own in step.own]

            def taken() -> JointCandidate | None:
                longest = max(
                    excess(body, each) for body, each in zip(now.bodies, steps, strict=True)
                )
                shorter = [each / max(longest, 1.0) for each in steps]
                first = space.moved(now.bodies[0], shorter[0])
                if first is None:
                    return None
                rest = [
                    replace(moved(body, each), shape=first.shape)
                    for body, each in zip(now.bodies[1:], shorter[1:], strict=True)
                ]
                return objective.evaluate([first, *rest])

            return Offer(promised=step.promised, taken=taken)

        return offer

    found = descend(
        objective.evaluate(start),
        paraboloid,
        max_evaluations=max_evaluations,
        settled=settled_nats,
        on_accepted=lambda candidate: on_energies(candidate.energies),
    )
    return JointMinimum(
        candidate=found.point, converged=found.converged, evaluations=found.evaluations
    )
