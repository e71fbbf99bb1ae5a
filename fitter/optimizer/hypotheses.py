"""What clicks cannot tell the picture may: a short search from each reading of the clicks."""

from collections.abc import Sequence
from dataclasses import dataclass

from fitter.energies.objective import Objective
from fitter.optimizer.alternation import BodySearch
from fitter.parameters import BodyParameters


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class JudgedEnd:
    """Where a search ended and what the comparing objective says of it, nats.

    The rendering is not kept: it would be 3 MB a reading for the rest of the fit.
    """

    parameters: BodyParameters
    total: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TriedHypotheses:
    """The searches' ends, in the order of the hypotheses, judged by one objective.

    ``best`` indexes them, one of those that were searched on; ``evaluations`` counts true energies.
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
    """Search from each start, search on from the best ends, and compare.

    Parameters
    ----------
    wide
        With a boundary that pulls from afar: what the searches minimise.
    sharp
        With one that rejects what is far: what the ends are compared by.
    starts
        Bodies to begin with.
    trial, contenders, contest
        Minimises an objective from each start; how many of the best ends go on; minimises from
        those.
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
