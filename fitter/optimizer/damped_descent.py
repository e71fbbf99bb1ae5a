"""Damped Gauss-Newton, accepted on the true energy: the loop, whatever the unknowns are.

A paraboloid that approximates the energy at the present point offers a step for any damping; a step
is accepted only if the true energy decreased there, not just the paraboloid.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar, runtime_checkable

import numpy as np

_FIRST_DAMPING = 1e-2
_SMALLEST_DAMPING, _LARGEST_DAMPING = 1e-6, 1e4
# After Nielsen: damping falls, at most to a third, where the step gained what was predicted, rises
# where it gained less than half of that, and rises twice as fast with every further rejection.
# A fixed rise and fall had half of its evaluations rejected and ended 2 to 12 % higher.
_FASTEST_FALL, _FASTEST_RISE = 1.0 / 3.0, 5.0
_FIRST_RISE = 2.0
_PROMISED_AFTER_REJECTION = 0.7
"""Where a step was rejected, one is tried that promises at most this share of it: with a damping so
small that it changes nothing, the next step would end nearly where the rejected one did."""

SETTLED_NATS = 0.05
"""A step that promises less is not tried, and two in a row that gain less end the search. A tenth
of a nat changes a likelihood by a tenth; the pixel grid at the outline makes the energy about as
rough."""

NEARLY_SETTLED_NATS = 0.2
"""The same of a search that another follows, about other evidence."""

EnergyObserver = Callable[[Mapping[str, float]], None]


@runtime_checkable
class Evaluated(Protocol):
    """A point at which the true energy is known, by term and in total, nats."""

    @property
    def energies(self) -> Mapping[str, float]:
        """By term."""
        ...

    @property
    def total(self) -> float:
        """Their sum."""
        ...


Point = TypeVar("Point", bound=Evaluated)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Offer(Generic[Point]):
    """A step that could be taken.

    Attributes
    ----------
    promised
        By how much the paraboloid decreases, nats.
    taken
        Evaluates the energy where the step ends; None where there is nothing to evaluate.
    """

    promised: float
    taken: Callable[[], Point | None]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Descent(Generic[Point]):
    """Where a search ended.

    ``converged`` is False if it ran out of evaluations; ``evaluations`` counts true energies.
    """

    point: Point
    converged: bool
    evaluations: int


def descend(
    start: Point,
    paraboloid: Callable[[Point], Callable[[float], Offer[Point]]],
    *,
    max_evaluations: int,
    on_energies: EnergyObserver,
    settled_nats: float = SETTLED_NATS,
) -> Descent[Point]:
    """Step until steps gain less than the tolerance or no damping helps.

    Parameters
    ----------
    start
        Where the search begins; it counts as one evaluation.
    paraboloid
        Gives, at a point, the step for each damping, which is a share of the diagonal.
    max_evaluations
        Of the true energy.
    on_energies
        Receives the energies of every accepted point.
    settled_nats
        The tolerance.
    """
    now = start
    damping, rise, evaluations, settled = _FIRST_DAMPING, _FIRST_RISE, 1, 0
    on_energies(now.energies)
    while evaluations < max_evaluations:
        offered = paraboloid(now)
        accepted: Point | None = None
        most_promised = np.inf
        while evaluations < max_evaluations and damping < _LARGEST_DAMPING:
            offer = offered(damping)
            if offer.promised < settled_nats:
                return Descent(point=now, converged=True, evaluations=evaluations)
            if offer.promised <= most_promised:
                reached = offer.taken()
                evaluations += 1
                if reached is not None and reached.total < now.total:
                    accepted = reached
                    change = damping_change((now.total - reached.total) / offer.promised)
                    damping = max(damping * change, _SMALLEST_DAMPING)
                    rise = _FIRST_RISE
                    break
                most_promised = _PROMISED_AFTER_REJECTION * offer.promised
            damping *= rise
            rise *= 2.0
        if accepted is None:
            return Descent(
                point=now, converged=damping >= _LARGEST_DAMPING, evaluations=evaluations
            )
        small = now.total - accepted.total < settled_nats
        settled = settled + 1 if small else 0
        now = accepted
        on_energies(now.energies)
        if settled == 2:
            return Descent(point=now, converged=True, evaluations=evaluations)
    return Descent(point=now, converged=False, evaluations=evaluations)


def damping_change(gain: float) -> float:
    """Factor of the damping after a step that gained this share of what it promised."""
    return float(np.clip(1.0 - (2.0 * gain - 1.0) ** 3, _FASTEST_FALL, _FASTEST_RISE))
