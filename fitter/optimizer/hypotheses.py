"""Ambiguities of the clicks resolved by the picture: a short search from each reading."""

from collections.abc import Sequence
from dataclasses import dataclass

from fitter.energies.joint_objective import JointObjective
from fitter.energies.objective import Body, Candidate
from fitter.optimizer.search import BodySearch


@dataclass(frozen=True, slots=True, kw_only=True)
class TriedHypotheses:
    """Where the searches ended, in the order of the hypotheses, compared under one objective.

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
