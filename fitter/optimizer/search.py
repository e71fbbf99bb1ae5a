"""Searches for the body of least energy: which optimiser is used, and for how long.

The default is damped Gauss-Newton on E1 or E2, accepted on the true energy. Rows from the contour,
the edges, the clicks, the spheres and the shading give a 74 x 74 normal matrix of each picture; the
gradient is exact, by the reverse mode of the body. Pictures meet in the shape
(:mod:`fitter.optimizer.joint_equations`). The loop is :mod:`fitter.numerics.damped_descent`. The
paper's optimiser is Nelder and Mead's simplex search on the same energy (section 3).
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from fitter.arrays import Image
from fitter.energies.correspondence_lines import correspondence_lines
from fitter.energies.objective import (
    Body,
    Candidate,
    EnergyObserver,
    JointCandidate,
    JointObjective,
    Objective,
)
from fitter.evidence.loose_outline import LooseOutline
from fitter.numerics.damped_descent import Offer, descend
from fitter.optimizer.free_space import excess, free_space
from fitter.optimizer.joint_equations import joint_equations
from fitter.vocabulary.choices import OptimizerKind

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
