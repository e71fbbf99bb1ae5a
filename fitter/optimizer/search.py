"""Which optimiser is used, and for how long."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

from fitter.energies.joint_objective import JointObjective
from fitter.energies.objective import Body, EnergyObserver
from fitter.optimizer.gauss_newton import SETTLED_NATS, Minimum, minimize_gauss_newton
from fitter.optimizer.simplex import minimize_simplex
from fitter.vocabulary.choices import OptimizerKind

BodySearch = Callable[[JointObjective, Sequence[Body]], Minimum]
"""From a body in each picture to a minimum."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchLimits:
    """Limits on the number of true energies computed.

    Attributes
    ----------
    first
        For the first body, before the second segmentation.
    hypotheses, trial
        How many readings of the clicks are tried on the picture, and for how long.
    contenders, contest
        How many of the best are searched further, and for how long.
    hopeless_nats
        A reading whose trial ends this far above the best is not searched further.
    silhouette_and_edges
        From the best of these to the minimum of E1.
    shading_round
        For the body in each round of the alternation.
    """

    first: int
    hypotheses: int
    trial: int
    contenders: int
    contest: int
    hopeless_nats: float
    silhouette_and_edges: int
    shading_round: int


_LIMITS: Mapping[OptimizerKind, SearchLimits] = {
    OptimizerKind.GAUSS_NEWTON: SearchLimits(
        first=5,
        hypotheses=4,
        trial=2,
        contenders=2,
        contest=4,
        hopeless_nats=12.0,
        silhouette_and_edges=100,
        shading_round=40,
    ),
    # The paper's search needs tens of thousands; this is as long as a request can wait (about two
    # minutes), and the outcome says that the limit was reached.
    OptimizerKind.SIMPLEX: SearchLimits(
        first=150,
        hypotheses=2,
        trial=150,
        contenders=1,
        contest=150,
        hopeless_nats=float("inf"),
        silhouette_and_edges=6000,
        shading_round=2500,
    ),
}


def limits_of(kind: OptimizerKind) -> SearchLimits:
    """Limits that suit an optimiser."""
    return _LIMITS[kind]


def body_search(
    kind: OptimizerKind,
    max_evaluations: int,
    on_energies: EnergyObserver,
    settled_nats: float = SETTLED_NATS,
) -> BodySearch:
    """A search over the bodies with everything fixed but the objective and the start.

    ``settled_nats`` is the gain below which steps end a search that follows the gradient.
    """
    if kind is OptimizerKind.SIMPLEX:
        return partial(minimize_simplex, max_evaluations=max_evaluations, on_energies=on_energies)
    return partial(
        minimize_gauss_newton,
        max_evaluations=max_evaluations,
        on_energies=on_energies,
        settled_nats=settled_nats,
    )
