"""The figures that speed is judged by, each beside what it is to be."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from fitter.training.report.text_tables import note_lines, table_lines
from tests.benchmarks import against, baseline, demo, idle, overhead, simplex, throughput
from tests.benchmarks.spent import median


@dataclass(frozen=True, slots=True, kw_only=True)
class Goal:
    """A bound: ``at_most`` that, or at least that."""

    figure: str
    bound: float
    at_most: bool = True
    decimals: int = 2
    unit: str = ""

    def row(self, found: float | None) -> tuple[str, str, str, str]:
        """Figure, what was found, the goal, and whether it is met."""
        goal = f"{'<=' if self.at_most else '>='} {self._told(self.bound)}"
        if found is None:
            return self.figure, "-", goal, "not measured"
        is_met = found <= self.bound if self.at_most else found >= self.bound
        return self.figure, self._told(found), goal, "met" if is_met else "missed"

    def _told(self, value: float) -> str:
        return f"{value:.{self.decimals}f}{self.unit}"


OF_BASELINE = (
    Goal(figure="SES fit, 480x640", bound=0.45),
    Goal(figure="SES fit, 960x1280", bound=0.45),
    Goal(figure="pictures and meshes, 480x640", bound=0.25),
    Goal(figure="pictures and meshes, 960x1280", bound=0.25),
    Goal(figure="upload of 12 megapixels to result and files", bound=0.5),
)
"""As shares of what :data:`tests.benchmarks.baseline.REVISION` takes; named as the probes are."""

SCAN = Goal(figure="front and side over a single fit", bound=1.8)

OWN: Mapping[Goal, Callable[[int], float]] = {
    Goal(figure="the service's own cost on small SE fits", bound=10.0, decimals=0, unit=" %"): (
        lambda fits: 100.0 * (1.0 - median([each.share for each in overhead.rounds(fits)]))
    ),
    Goal(figure="`maquette demo`, warm", bound=5.0, decimals=1, unit=" s"): (
        lambda _: median(demo.walls_s(3))
    ),
    Goal(figure="`maquette serve` with one worker, idle", bound=400.0, decimals=0, unit=" MiB"): (
        lambda _: median(idle.shares_mib(1))
    ),
    Goal(
        figure="the paper's simplex on the same energy", bound=400.0, at_most=False, decimals=0
    ): lambda _: median([each.times_slower for each in simplex.contested(3)]),
    Goal(figure="SES fits a second, two processes over one", bound=1.9, at_most=False): (
        lambda fits: (rates := throughput.fits_a_second(fits))[2] / rates[1]
    ),
}
"""What needs no other checkout, with how it is measured, given a number of fits."""


def lines(count: int) -> Iterator[str]:
    """One table; ``count`` fits for the figures of the service and of two processes."""
    found = {goal: measure(count) for goal, measure in OWN.items()}
    compared: Mapping[str, against.Comparison] = {}
    missing = ""
    try:
        with baseline.checkout() as folder:
            compared = against.comparisons(folder)
    except baseline.NoBaselineError as error:
        missing = f"Commit {baseline.REVISION} cannot be had here: {error} "
    ratios = {name: each.ratio for name, each in compared.items()}
    scan = compared.get(SCAN.figure)
    yield from table_lines(
        f"What was to be reached; the first {len(OF_BASELINE)} are shares of commit "
        f"{baseline.REVISION}",
        ("", "found", "goal", ""),
        [
            *(goal.row(ratios.get(goal.figure)) for goal in OF_BASELINE),
            SCAN.row(None if scan is None else scan.here),
            *(goal.row(value) for goal, value in found.items()),
        ],
    )
    yield from note_lines(
        f"{missing}Each figure is that of the part of its name, which tells how it is measured."
    )
