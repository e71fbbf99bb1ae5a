"""Ambiguities of the clicks resolved by the picture: a short search from each reading."""

from collections.abc import Sequence
from dataclasses import dataclass

from fitter.energies.objective import Body, Candidate, Objective
from fitter.optimizer.alternation import BodySearch
from fitter.parameters import BodyParameters


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class JudgedEnd:
    """Where a search ended, and its energy under the objective used for comparison, nats.

    The rendering is not kept: it would take 3 MB per reading for the rest of the fit.
    """

    parameters: BodyParameters
    total: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TriedHypotheses:
    """Where the searches ended, in the order of the hypotheses, compared under one objective.

    ``best`` is the index of the best among those searched further, and ``winner`` where its search
    ended; ``evaluations`` counts true energies.
    """

    ends: tuple[JudgedEnd, ...]
    best: int
    winner: Candidate
    evaluations: int


def try_hypotheses(
    wide: Objective,
    sharp: Objective,
    starts: Sequence[Body],
    *,
    trial: BodySearch,
    contenders: int,
    hopeless_nats: float,
    contest: BodySearch,
) -> TriedHypotheses:
    """Search from each start, search further from the best results, and compare.

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
    found = [trial(wide, start) for start in starts]
    evaluations = sum(minimum.evaluations for minimum in found)
    by_energy = sorted(range(len(found)), key=lambda index: found[index].candidate.total)
    bound = found[by_energy[0]].candidate.total + hopeless_nats
    contending = [index for index in by_energy[:contenders] if found[index].candidate.total < bound]
    # One alone has nothing to win: whoever searches on from it does so with a sharper objective.
    for index in contending if len(contending) > 1 else ():
        found[index] = contest(wide, found[index].candidate)
        evaluations += found[index].evaluations
    ends = tuple(
        JudgedEnd(
            parameters=minimum.candidate.parameters,
            total=sharp.evaluate(minimum.candidate).total,
        )
        for minimum in found
    )
    best = min(contending, key=lambda index: ends[index].total)
    return TriedHypotheses(
        ends=ends,
        best=best,
        winner=found[best].candidate,
        evaluations=evaluations + len(ends),
    )
