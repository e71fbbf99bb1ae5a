"""The project's goals of speed, and how near they are: one table of all of them."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from statistics import median

from fitter.training.report.text_tables import note_lines, table_lines
from tests.benchmarks import goal_figures
from tests.benchmarks.checkouts import BASELINE, NoCheckoutError

OF_BASELINE = "of the baseline"


@dataclass(frozen=True, slots=True, kw_only=True)
class Goal:
    """A bound on the median of a figure: at most, unless it is one that is to be large."""

    figure: str
    bound: float
    unit: str = ""
    at_least: bool = False

    def met_by(self, value: float) -> bool:
        """Say whether a figure is within the bound."""
        return value >= self.bound if self.at_least else value <= self.bound

    def __str__(self) -> str:
        return f"{'at least' if self.at_least else 'at most'} {self.bound:g} {self.unit}".rstrip()


GOALS = (
    Goal(figure="SES fit, 480x640", bound=0.45, unit=OF_BASELINE),
    Goal(figure="SES fit, 960x1280", bound=0.45, unit=OF_BASELINE),
    Goal(figure="pictures and meshes, 480x640", bound=0.25, unit=OF_BASELINE),
    Goal(figure="pictures and meshes, 960x1280", bound=0.25, unit=OF_BASELINE),
    Goal(figure="upload of 12 megapixels to result and files", bound=0.5, unit=OF_BASELINE),
    Goal(figure=goal_figures.OWN_COST, bound=10.0, unit="%"),
    Goal(figure="front and side over a single fit", bound=1.8),
    Goal(figure=goal_figures.DEMO, bound=5.0, unit="s"),
    Goal(figure=goal_figures.IDLE, bound=400.0, unit="MiB"),
    Goal(figure=goal_figures.SIMPLEX, bound=400.0, at_least=True),
    Goal(figure=goal_figures.PROCESSES, bound=1.9, at_least=True),
)
"""One for each figure, in the order of the table."""


def lines(count: int) -> Iterator[str]:
    """All goals, those that are shares of the baseline over ``count`` rounds in turns."""
    figures = dict(goal_figures.of_the_command())
    note = (
        f"The baseline is {BASELINE[:7]}, in turns with this checkout: processor time, of the "
        "upload wall time. The simplex is stopped at so many energies, most often before it has "
        "converged: it is at least as many times slower as stands here. A figure is the median; "
        "lowest and highest are of rounds, runs or pictures."
    )
    try:
        figures |= goal_figures.of_the_baseline(count)
    except NoCheckoutError as error:
        note = f"{note} Here it could not be had: {error}."
    figures |= goal_figures.of_this_checkout()
    yield from table_lines(
        "Goals of speed",
        ("", "figure", "lowest", "highest", "goal", ""),
        [_row(goal, figures.get(goal.figure, ())) for goal in GOALS],
    )
    yield from note_lines(note)


def _row(goal: Goal, values: Sequence[float]) -> tuple[str, ...]:
    if not values:
        return (goal.figure, "", "", "", str(goal), "not measured")
    figure = median(values)
    shown = (_shown(value) for value in (figure, min(values), max(values)))
    return (goal.figure, *shown, str(goal), "met" if goal.met_by(figure) else "missed")


def _shown(value: float) -> str:
    return f"{value:.2f}" if abs(value) < 100.0 else f"{value:.0f}"
