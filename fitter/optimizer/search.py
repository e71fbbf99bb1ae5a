"""Which optimiser is used, and for how long."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

from fitter.arrays import Image
from fitter.energies.joint_objective import JointObjective
from fitter.energies.objective import Body, Candidate, EnergyObserver, Objective
from fitter.evidence.correspondence_lines import correspondence_lines
from fitter.evidence.loose_outline import LooseOutline
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


def with_lines_about(objective: Objective, body: Body, display: Image) -> Objective:
    """The objective with lines placed across the contour of a body near the person.

    ``display`` (h, w, 3) holds the picture's display values in [0, 1].
    """
    seen = objective.see(body)
    silhouette = objective.evidence.silhouette
    clothes = None
    if silhouette.cloth is not None and silhouette.fullness is not None:
        clothes = LooseOutline(
            mask=silhouette.mask, cloth=silhouette.cloth, fullness=silhouette.fullness
        )
    return objective.with_lines(
        correspondence_lines(seen.rendering, seen.edges, display, silhouette.confidence, clothes)
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class TriedHypotheses:
    """Ends of the searches, in the order of the hypotheses, compared under one objective.

    Attributes
    ----------
    totals
        The energy of each end, nats. The bodies are not kept: a rendering takes 3 MB.
    best
        Index of the best among those searched further.
    winner
        Where its search ended.
    evaluations
        True energies computed.
    """

    totals: tuple[float, ...]
    best: int
    winner: Candidate
    evaluations: int


def try_hypotheses(
    wide: JointObjective,
    sharp: JointObjective,
    starts: Sequence[Body],
    *,
    trial: BodySearch,
    contenders: int,
    hopeless_nats: float,
    contest: BodySearch,
) -> TriedHypotheses:
    """Search one picture from each start, search further from the best results, and compare.

    Parameters
    ----------
    wide
        Objective with a boundary that pulls from afar: what the searches minimise.
    sharp
        Objective with one that rejects what is far: what the results are compared by.
    starts
        Bodies to begin with.
    trial
        The search from each start.
    contenders, hopeless_nats
        How many of the best results go on at most; only those less than so far above the best do.
    contest
        The search from those, where there are several.
    """
    found = [trial(wide, [start]) for start in starts]
    evaluations = sum(minimum.evaluations for minimum in found)
    by_energy = sorted(range(len(found)), key=lambda index: found[index].candidate.total)
    bound = found[by_energy[0]].candidate.total + hopeless_nats
    contending = [index for index in by_energy[:contenders] if found[index].candidate.total < bound]
    # One alone has nothing to win: whoever searches on from it does so with a sharper objective.
    for index in contending if len(contending) > 1 else ():
        found[index] = contest(wide, found[index].candidate.views)
        evaluations += found[index].evaluations
    totals = tuple(sharp.evaluate(minimum.candidate.views).total for minimum in found)
    best = min(contending, key=lambda index: totals[index])
    (winner,) = found[best].candidate.views
    return TriedHypotheses(
        totals=totals, best=best, winner=winner, evaluations=evaluations + len(totals)
    )
