"""Gauss-Newton against the paper's simplex: the same energy from the same start."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from fitter.fits.pipeline import fit
from fitter.optimizer.gauss_newton import Minimum, minimize_gauss_newton
from fitter.optimizer.search import limits_of
from fitter.optimizer.simplex import minimize_simplex
from fitter.request import FitRequest
from fitter.training.report.text_tables import note_lines, table_lines
from fitter.vocabulary.choices import OptimizerKind, OutlineKind
from tests.benchmarks.recorded_searches import Search, recorded_searches
from tests.benchmarks.requests import suite_requests, warm_up
from tests.benchmarks.spent import Spent, median, timed
from tests.one_picture import changed

SIMPLEX_EVALUATIONS = limits_of(OptimizerKind.SIMPLEX).silhouette_and_edges
NEWTON_EVALUATIONS = limits_of(OptimizerKind.GAUSS_NEWTON).silhouette_and_edges


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Contest:
    """Both searches' ends with what they took."""

    energy: str
    started_at: float
    newton: Minimum
    newton_spent: Spent
    simplex: Minimum
    simplex_spent: Spent

    @property
    def times_slower(self) -> float:
        """Processor time of the simplex over that of Gauss-Newton."""
        return self.simplex_spent.processor_s / self.newton_spent.processor_s

    @property
    def times_higher(self) -> float:
        """Final energy of the simplex over that of Gauss-Newton."""
        return self.simplex.candidate.total / self.newton.candidate.total


def lines(count: int) -> Iterator[str]:
    """Two contests a picture."""
    contests = measured(count)
    yield from table_lines(
        f"Gauss-Newton and simplex on the same energy from the same start, {count} pictures, "
        "480x640",
        (
            "energy",
            "at start",
            "Gauss-Newton",
            "energies",
            "s",
            "simplex",
            "energies",
            "s",
            "times slower",
            "times higher",
        ),
        [_row(contest) for contest in contests],
    )
    yield from note_lines(_summary(contests))


def measured(count: int) -> list[Contest]:
    """The contests over ``count`` pictures."""
    warm_up()
    return [
        _contest(name, search)
        for request in suite_requests(count, width=480, height=640)
        for name, search in _searches(request).items()
    ]


def _searches(request: FitRequest) -> Mapping[str, Search]:
    """E1 from the first body, which clicks alone gave; E2's first round from the end of E1.

    By the segmented region: lines are laid out across a body that is near already.
    """
    with recorded_searches() as searches:
        fit(changed(request, outline=OutlineKind.GRABCUT))
    unshaded = [each for each in searches if not is_lit(each)]
    shaded = [each for each in searches if is_lit(each)]
    whole = replace(unshaded[-1], start=searches[0].start)
    return {"E1": whole} | ({"E2": shaded[0]} if shaded else {})


def is_lit(search: Search) -> bool:
    """Whether it was of E2."""
    return any(view.evidence.shading is not None for view in search.objective.views)


def _contest(energy: str, search: Search) -> Contest:
    newton, newton_spent = timed(
        lambda: minimize_gauss_newton(
            search.objective,
            search.start,
            max_evaluations=NEWTON_EVALUATIONS,
            on_energies=_unobserved,
        )
    )
    simplex, simplex_spent = timed(
        lambda: minimize_simplex(
            search.objective,
            search.start,
            max_evaluations=SIMPLEX_EVALUATIONS,
            on_energies=_unobserved,
        )
    )
    return Contest(
        energy=energy,
        started_at=search.objective.evaluate(search.start).total,
        newton=newton,
        newton_spent=newton_spent,
        simplex=simplex,
        simplex_spent=simplex_spent,
    )


def _unobserved(_: Mapping[str, float]) -> None:
    """Tell nobody."""


def _row(contest: Contest) -> tuple[str, ...]:
    return (
        contest.energy,
        f"{contest.started_at:.1f}",
        f"{contest.newton.candidate.total:.1f}",
        str(contest.newton.evaluations),
        f"{contest.newton_spent.processor_s:.2f}",
        f"{contest.simplex.candidate.total:.1f}",
        str(contest.simplex.evaluations),
        f"{contest.simplex_spent.processor_s:.1f}",
        f"{contest.times_slower:.0f}",
        f"{contest.times_higher:.3f}",
    )


def _summary(contests: Sequence[Contest]) -> str:
    better = sum(each.newton.candidate.total <= each.simplex.candidate.total for each in contests)
    capped = sum(not each.simplex.converged for each in contests)
    return (
        f"The simplex may compute {SIMPLEX_EVALUATIONS} energies, Gauss-Newton "
        f"{NEWTON_EVALUATIONS}. {capped} of {len(contests)} simplex searches were stopped there "
        "before they had converged: how many times slower the simplex is, is at least what stands "
        "here. "
        f"Gauss-Newton's energy is equal or lower in {better} of {len(contests)}; the simplex "
        f"takes {median([each.times_slower for each in contests]):.0f} times its processor time "
        f"(median) and ends {median([each.times_higher for each in contests]):.3f} times as high."
    )
