"""What clicks cannot tell the picture may: a short search from each reading of the clicks."""

from collections.abc import Sequence
from dataclasses import dataclass

from fitter.energies.objective import Objective
from fitter.optimizer.alternation import BodySearch
from fitter.optimizer.gauss_newton import Minimum
from fitter.parameters import BodyParameters


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TriedHypotheses:
    """The short searches' ends, in the order of the hypotheses; ``best`` indexes them."""

    ends: tuple[Minimum, ...]
    best: int

    @property
    def evaluations(self) -> int:
        """True energies computed in all."""
        return sum(end.evaluations for end in self.ends)


def try_hypotheses(
    objective: Objective, starts: Sequence[BodyParameters], *, search: BodySearch
) -> TriedHypotheses:
    """Search from each start and compare the true energies reached."""
    ends = tuple(search(objective, start) for start in starts)
    best = min(range(len(ends)), key=lambda index: ends[index].candidate.total)
    return TriedHypotheses(ends=ends, best=best)
