"""The project's goals of speed, and how near they are: one table of all of them."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from statistics import median

from fitter.training.report.survey_comparison import note_lines, table_lines
from tests.benchmarks import demo, idle, overhead, several, throughput

SERVICES = 2
DEMOS = 3
PAIRS = 3
SMALL_FITS = 60
"""In a row: the first of them is its process's first, and what that costs is shared by all."""
FITS_A_PROCESS = 10


@dataclass(frozen=True, slots=True, kw_only=True)
class Goal:
    """A bound on the median of a figure: at most, unless it is one that is to be large."""

    figure: str
    measured: Callable[[], Sequence[float]]
    bound: float
    unit: str = ""
    at_least: bool = False

    def met_by(self, value: float) -> bool:
        """Say whether a figure is within the bound."""
        return value >= self.bound if self.at_least else value <= self.bound

    def __str__(self) -> str:
        return f"{'at least' if self.at_least else 'at most'} {self.bound:g} {self.unit}".rstrip()


def _own_costs() -> list[float]:
    return [100.0 * (1.0 - each.served_share) for each in overhead.measured(SMALL_FITS)]


def _two_over_one() -> list[float]:
    rates = throughput.measured(FITS_A_PROCESS)
    return [rates[2] / rates[1]]


GOALS = (
    # The demo comes first: it compiles the kernels if they are not yet, and nothing idle does then.
    Goal(
        figure="`maquette demo`, warm", measured=lambda: demo.measured(DEMOS), bound=5.0, unit="s"
    ),
    Goal(
        figure="resident memory of `maquette serve`, one worker, idle",
        measured=lambda: [each.share_mib for each in idle.measured(SERVICES)],
        bound=400.0,
        unit="MiB",
    ),
    Goal(
        figure="the service's own cost on small SE fits", measured=_own_costs, bound=10.0, unit="%"
    ),
    Goal(
        figure="front and side over a single fit",
        measured=lambda: several.measured(PAIRS),
        bound=1.8,
    ),
    Goal(
        figure="SES fits a second, two processes over one",
        measured=_two_over_one,
        bound=1.9,
        at_least=True,
    ),
)
"""One for each figure, in the order in which they are measured."""


def lines(goals: Sequence[Goal] = GOALS) -> Iterator[str]:
    """All goals beside their figures."""
    yield from table_lines(
        "Goals of speed",
        ("", "figure", "lowest", "highest", "goal", ""),
        [_row(goal, goal.measured()) for goal in goals],
    )
    yield from note_lines(
        "A figure is the median; lowest and highest are of rounds, runs or people."
    )


def _row(goal: Goal, values: Sequence[float]) -> tuple[str, ...]:
    figure = median(values)
    shown = (f"{value:.2f}" for value in (figure, min(values), max(values)))
    return (goal.figure, *shown, str(goal), "met" if goal.met_by(figure) else "missed")
