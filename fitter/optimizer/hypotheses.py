"""What clicks cannot tell the picture may: a short search from each reading of the clicks."""

from collections.abc import Sequence
from dataclasses import dataclass

from fitter.energies.objective import Candidate, Objective
from fitter.optimizer.alternation import BodySearch
from fitter.parameters import BodyParameters


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TriedHypotheses:
    """The short searches' ends, in the order of the hypotheses, judged by one objective.

    ``best`` indexes them; ``evaluations`` counts true energies.
    """

    ends: tuple[Candidate, ...]
    best: int
    evaluations: int


def try_hypotheses(
    wide: Objective, sharp: Objective, starts: Sequence[BodyParameters], *, search: BodySearch
) -> TriedHypotheses:
    """Search from each start and compare.

    Parameters
    ----------
    wide
        With a boundary that pulls from afar: what the searches minimise.
    sharp
        With one that rejects what is far: what the ends are compared by.
    starts
        Bodies to begin with.
    search
        Minimises an objective from given parameters.
    """
    found = [search(wide, start) for start in starts]
    ends = tuple(sharp.evaluate(minimum.candidate.parameters) for minimum in found)
    return TriedHypotheses(
        ends=ends,
        best=min(range(len(ends)), key=lambda index: ends[index].total),
        evaluations=sum(minimum.evaluations + 1 for minimum in found),
    )
