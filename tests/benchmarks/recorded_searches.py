"""What a fit searched: every objective with the start and the end of the search over it."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

from fitter.energies.joint_objective import JointObjective
from fitter.energies.objective import Body, EnergyObserver
from fitter.fits import outline_search, search
from fitter.optimizer.gauss_newton import SETTLED_NATS, Minimum
from fitter.optimizer.search import BodySearch, body_search
from fitter.vocabulary.choices import OptimizerKind


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Search:
    """One search of a fit, which ended where a step gained less than ``settled_nats``."""

    objective: JointObjective
    start: Sequence[Body]
    end: Minimum
    settled_nats: float


@contextmanager
def recorded_searches() -> Iterator[list[Search]]:
    """While the context lasts, the searches of every fit in the order they were made."""
    found: list[Search] = []

    def recording(
        kind: OptimizerKind,
        max_evaluations: int,
        on_energies: EnergyObserver,
        settled_nats: float = SETTLED_NATS,
    ) -> BodySearch:
        made = body_search(kind, max_evaluations, on_energies, settled_nats)

        def recorded(objective: JointObjective, start: Sequence[Body]) -> Minimum:
            end = made(objective, start)
            found.append(
                Search(objective=objective, start=start, end=end, settled_nats=settled_nats)
            )
            return end

        return recorded

    for module in (outline_search, search):
        module.body_search = recording
    try:
        yield found
    finally:
        for module in (outline_search, search):
            module.body_search = body_search
