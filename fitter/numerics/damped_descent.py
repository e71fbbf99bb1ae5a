"""Damped Gauss-Newton, accepted on the true energy: the loop of every search, whatever is sought.

A paraboloid that approximates the energy at the present point offers a step for any damping; a step
is accepted only if the true energy decreased there, not just the paraboloid. Who searches says what
a point is, how the paraboloid is made there and where a step leads; most have a matrix and a
gradient, for which :func:`damped_steps` makes the offers.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Generic, Protocol, TypeVar, runtime_checkable

import numpy as np
from jaxtyping import Float

from fitter.numerics import _damping_kernels as kernels

FIRST_DAMPING, LARGEST_DAMPING = 1e-2, 1e4

Step = Float[np.ndarray, " n"]
"""A change of all unknowns. Its name is for functions within functions: an annotation is evaluated
whenever they are defined, and takes 30 microseconds where it makes a type."""


@runtime_checkable
class Evaluated(Protocol):
    """A point at which the true energy is known."""

    @property
    def total(self) -> float:
        """The energy."""
        ...


Point = TypeVar("Point", bound=Evaluated)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Offer(Generic[Point]):
    """A step that could be taken.

    Attributes
    ----------
    promised
        By how much the paraboloid decreases, in the energy's unit.
    taken
        Evaluates the energy where the step ends; None where there is nothing to evaluate.
    """

    promised: float
    taken: Callable[[], Point | None]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Descent(Generic[Point]):
    """End of a search.

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
    settled: float,
    settled_share: float = 0.0,
    first_damping: float = FIRST_DAMPING,
    largest_damping: float = LARGEST_DAMPING,
    on_accepted: Callable[[Point], None] | None = None,
) -> Descent[Point]:
    """Step until two steps in a row gain less than the tolerance, or no damping helps.

    A step that promises less than the tolerance is not tried, and ends the search.

    Parameters
    ----------
    start
        Where the search begins; it counts as one evaluation.
    paraboloid
        Gives, at a point, the step for each damping, which is a share of the diagonal.
    max_evaluations
        Of the true energy.
    settled, settled_share
        The tolerance: this much, and this share of the present energy.
    first_damping, largest_damping
        With which damping the search begins, and with which it gives up.
    on_accepted
        Receives the start and every accepted point.
    """
    now = start
    damping = kernels.Damping(first_damping, kernels.FIRST_RISE)
    evaluations, small_gains = 1, 0
    if on_accepted is not None:
        on_accepted(now)
    while evaluations < max_evaluations:
        offered = paraboloid(now)
        tolerance = settled + settled_share * now.total
        accepted: Point | None = None
        most_promised = np.inf
        while evaluations < max_evaluations and damping.share < largest_damping:
            offer = offered(damping.share)
            if offer.promised < tolerance:
                return Descent(point=now, converged=True, evaluations=evaluations)
            if offer.promised <= most_promised:
                reached = offer.taken()
                evaluations += 1
                if reached is not None and reached.total < now.total:
                    accepted = reached
                    gain = (now.total - reached.total) / offer.promised
                    damping = kernels.after_gain(damping, gain)
                    break
                most_promised = kernels.PROMISED_AFTER_REJECTION * offer.promised
            damping = kernels.after_rejection(damping)
        if accepted is None:
            return Descent(
                point=now, converged=damping.share >= largest_damping, evaluations=evaluations
            )
        small_gains = small_gains + 1 if now.total - accepted.total < tolerance else 0
        now = accepted
        if on_accepted is not None:
            on_accepted(now)
        if small_gains == 2:
            return Descent(point=now, converged=True, evaluations=evaluations)
    return Descent(point=now, converged=False, evaluations=evaluations)


def damped_steps(
    matrix: Float[np.ndarray, "n n"],
    gradient: Float[np.ndarray, " n"],
    taken: Callable[[Step], Point | None],
    *,
    floor: float,
) -> Callable[[float], Offer[Point]]:
    """The offers of the paraboloid ½ xᵀMx + gᵀx: for damping μ, (M + μ diag M + floor I) x = -g.

    ``taken`` evaluates the energy where a step x leads; ``floor`` keeps the matrix regular where
    an unknown has no curvature.
    """
    matrix, gradient = np.ascontiguousarray(matrix), np.ascontiguousarray(gradient)
    return partial(_offer, matrix, gradient, taken, floor)


def _offer(
    matrix: Float[np.ndarray, "n n"],
    gradient: Float[np.ndarray, " n"],
    taken: Callable[[Step], Point | None],
    floor: float,
    damping: float,
) -> Offer[Point]:
    step, promised = kernels.damped_step(matrix, gradient, damping, floor)
    return Offer(promised=promised, taken=lambda: taken(step))
