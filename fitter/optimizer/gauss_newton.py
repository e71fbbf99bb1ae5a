"""The default optimiser: damped Gauss-Newton on E1 or E2, accepted on the true energy.

Rows from the contour, the edges, the clicks, the spheres and the shading give a 74 x 74 normal
matrix; the gradient is exact, by the reverse mode of the body. A step is accepted only if the true
energy decreased, not just its quadratic model.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from fitter.energies.objective import Candidate, Objective
from fitter.optimizer.free_space import free_space
from fitter.optimizer.normal_equations import normal_equations
from fitter.optimizer.parameter_vector import limited
from fitter.parameters import BodyParameters

_FIRST_DAMPING = 1e-2
_SMALLEST_DAMPING, _LARGEST_DAMPING = 1e-6, 1e4
# After Nielsen: damping falls, at most to a third, where the step gained what was predicted, rises
# where it gained less than half of that, and rises twice as fast with every further rejection.
# A fixed rise and fall had half of its evaluations rejected and ended 2 to 12 % higher.
_FASTEST_FALL, _FASTEST_RISE = 1.0 / 3.0, 5.0
_FIRST_RISE = 2.0
# Nats: a step that promises less is not tried, and two in a row that gain less end the search. A
# tenth of a nat changes a likelihood by a tenth; the pixel grid at the outline makes the energy
# about as rough.
_SETTLED_NATS = 0.05

EnergyObserver = Callable[[Mapping[str, float]], None]


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
    start: BodyParameters,
    *,
    max_evaluations: int,
    on_energies: EnergyObserver,
) -> Minimum:
    """Minimise from ``start`` until steps gain less than the tolerance or no damping helps.

    ``start`` has the attributes the objective holds.
    """
    now = objective.evaluate(start)
    damping, rise, evaluations, settled = _FIRST_DAMPING, _FIRST_RISE, 1, 0
    on_energies(now.energies)
    while evaluations < max_evaluations:
        matrix, gradient = normal_equations(objective, now)
        space = free_space(objective.attributes.held, now.parameters)
        inner = space.directions.T @ matrix @ space.directions
        pull = gradient @ space.directions
        diagonal = inner.diagonal()
        accepted: Candidate | None = None
        while evaluations < max_evaluations and damping < _LARGEST_DAMPING:
            damped = inner + np.diag(damping * diagonal + 1e-9)
            step = np.linalg.solve(damped, -pull)
            promised = -float(step @ (pull + 0.5 * inner @ step))
            if promised < _SETTLED_NATS:
                return Minimum(candidate=now, converged=True, evaluations=evaluations)
            reached = space.moved(now.parameters, limited(now.parameters, space.directions @ step))
            candidate = None if reached is None else objective.evaluate(reached)
            evaluations += 1
            if candidate is not None and candidate.total < now.total:
                accepted = candidate
                gain = (now.total - candidate.total) / promised
                change = np.clip(1.0 - (2.0 * gain - 1.0) ** 3, _FASTEST_FALL, _FASTEST_RISE)
                damping = max(damping * float(change), _SMALLEST_DAMPING)
                rise = _FIRST_RISE
                break
            damping *= rise
            rise *= 2.0
        if accepted is None:
            return Minimum(
                candidate=now,
                converged=damping >= _LARGEST_DAMPING,
                evaluations=evaluations,
            )
        small = now.total - accepted.total < _SETTLED_NATS
        settled = settled + 1 if small else 0
        now = accepted
        on_energies(now.energies)
        if settled == 2:
            return Minimum(candidate=now, converged=True, evaluations=evaluations)
    return Minimum(candidate=now, converged=False, evaluations=evaluations)
