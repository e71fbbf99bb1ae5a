"""What a fit searched: every objective with the start and the end of the search over it."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from fitter.energies.objective import Body, EnergyObserver, Objective
from fitter.fits import descents
from fitter.optimizer.alternation import BodySearch
from fitter.optimizer.gauss_newton import Minimum
from fitter.optimizer.search import body_search
from fitter.request import OptimizerKind


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Search:
    """One search of a fit."""

    objective: Objective
    start: Body
    end: Minimum


@contextmanager
def recorded_searches() -> Iterator[list[Search]]:
    """While the context lasts, the searches of every fit in the order they were made."""
    found: list[Search] = []

    def recording(
        kind: OptimizerKind,
        max_evaluations: int,
        on_energies: EnergyObserver,
        settled_nats: float,
    ) -> BodySearch:
        search = body_search(kind, max_evaluations, on_energies, settled_nats)

        def recorded(objective: Objective, start: Body) -> Minimum:
            end = search(objective, start)
            found.append(Search(objective=objective, start=start, end=end))
            return end

        return recorded

    descents.body_search = recording
    try:
        yield found
    finally:
        descents.body_search = body_search
