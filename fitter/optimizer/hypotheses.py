"""Ambiguities of the clicks resolved by the picture: a short search from each reading."""

from collections.abc import Sequence
from dataclasses import dataclass

from fitter.energies.objective import Objective
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

    ``best`` is the index of the best among those searched further; ``evaluations`` counts true
    energies.
    """

    ends: tuple[JudgedEnd, ...]
    best: int
    evaluations: int


def try_hypotheses(
    wide: Objective,
    sharp: Objective,
    starts: Sequence[BodyParameters],
    *,
    trial: BodySearch,
    contenders: int,
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
    trial, contenders, contest
        The search from each start; how many of the best results go on; the search from those.
    """
    found = [trial(wide, start) for start in starts]
    evaluations = sum(minimum.evaluations for minimum in found)
    by_energy = sorted(range(len(found)), key=lambda index: found[index].candidate.total)
    for index in by_energy[:contenders]:
        found[index] = contest(wide, found[index].candidate.parameters)
        evaluations += found[index].evaluations
    reached = [minimum.candidate.parameters for minimum in found]
    ends = tuple(
        JudgedEnd(parameters=parameters, total=sharp.evaluate(parameters).total)
        for parameters in reached
    )
    return TriedHypotheses(
        ends=ends,
        best=min(by_energy[:contenders], key=lambda index: ends[index].total),
        evaluations=evaluations + len(ends),
    )
