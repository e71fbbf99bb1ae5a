"""What the command line shows: progress bars while a fit runs, tables afterwards."""

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import Final

from rich.console import Console
from rich.progress import BarColumn, Progress, SpinnerColumn, TaskID, TextColumn, TimeElapsedColumn
from rich.table import Table

from api_schemas.problems import Problem
from api_schemas.results import Assumption, Finding, FitResult, FitWarning, Measurement
from fitter.vocabulary.measurements import group_of
from fitter.vocabulary.outcomes import Severity

SHADED: Final = "SES"
UNSHADED: Final = "SE"
WITHHELD: Final = "[bold]Measurements are withheld;[/] with --force they are given."


class StageBars:
    """One bar per stage, running from its first report to the next stage's, and one for all."""

    def __init__(self, progress: Progress) -> None:
        self._progress = progress
        self._whole = progress.add_task("whole fit", total=1.0)
        self._stage: str | None = None
        self._bar: TaskID | None = None

    def show(self, stage: str | None, share: float) -> None:
        """Take a report: the stage, and the share of the whole fit done."""
        self._progress.update(self._whole, completed=share)
        if stage is not None and stage != self._stage:
            self._finish_stage()
            self._stage = stage
            self._bar = self._progress.add_task(stage.replace("_", " "), total=None)

    def finish(self) -> None:
        """Complete the bars: the fit is done."""
        self._finish_stage()
        self._progress.update(self._whole, completed=1.0)

    def _finish_stage(self) -> None:
        if self._bar is not None:
            self._progress.update(self._bar, total=1.0, completed=1.0)
            self._progress.stop_task(self._bar)


@contextmanager
def stage_bars(console: Console) -> Iterator[StageBars]:
    """Show the bars of one fit while the context lasts."""
    with Progress(
        SpinnerColumn(),
        TextColumn("{task.description}"),
        BarColumn(),
        TimeElapsedColumn(),
        console=console,
    ) as progress:
        yield StageBars(progress)


def print_problem(console: Console, problem: Problem) -> None:
    """Say what is wrong and what to do."""
    console.print(f"[bold red]{problem.title}[/]", highlight=False)
    for error in problem.errors:
        console.print(f"  {error.field}: {error.reason} {error.remedy}", markup=False)
    if not problem.errors:
        console.print(f"  {problem.detail} {problem.remedy}", markup=False)


def print_result(
    console: Console, result: FitResult, *, truth: Mapping[str, float] | None = None
) -> None:
    """Print the measurements of SE and SES, next to the truth if there is one, and remarks."""
    if result.measurements:
        console.print(_measurements(result, truth or {}))
    else:
        console.print(WITHHELD)
    console.print(f"Verdict: {result.verdict} ({result.outcome_explanation})", highlight=False)
    for number, view in enumerate(result.views):
        shown = "" if view.view is None else f", {view.view}"
        console.print(
            f"View {number}{shown}: {view.outcome}, {view.verdict}. "
            f"Silhouette overlap {view.silhouette_overlap:.3f}.",
            highlight=False,
        )
        _print_findings(console, view.findings)
        _print_remarks(console, view.assumptions, view.warnings)
    if result.agreement is not None:
        console.print(f"Agreement of the views {result.agreement:.2f}.", highlight=False)
    console.print(
        f"{result.evaluations} evaluations, {sum(result.stage_seconds.values()):.1f} s.",
        highlight=False,
    )
    _print_remarks(console, result.assumptions, result.warnings)


def _print_findings(console: Console, findings: Iterable[Finding]) -> None:
    """What blocks is told by the outcome."""
    for each in findings:
        if each.severity is not Severity.BLOCKS:
            console.print(
                f"{each.severity} ({each.code}): {each.reason} {each.remedy}", markup=False
            )


def _print_remarks(
    console: Console, assumptions: Iterable[Assumption], warnings: Iterable[FitWarning]
) -> None:
    for assumption in assumptions:
        value = assumption.value
        shown = f"{value:.4g}" if isinstance(value, float) else value
        console.print(f"Assumed {assumption.quantity} = {shown}: {assumption.reason}", markup=False)
    for warning in warnings:
        console.print(f"Warning ({warning.code}): {warning.message}", markup=False)


def _spread(measurement: Measurement) -> str:
    error = measurement.standard_error
    if error is None:
        return ""
    shown = f"{error:.1f}"
    return "given" if measurement.given and shown == "0.0" else shown


def _measurements(result: FitResult, truth: Mapping[str, float]) -> Table:
    unshaded = next(
        (
            {each.name: each.value for each in stage.measurements}
            for stage in result.stages
            if stage.name == UNSHADED
        ),
        dict[str, float](),
    )
    shaded = result.cues == SHADED
    table = Table(title=f"Measurements, {result.gender}, {result.height_m:.3f} m")
    table.add_column("measurement")
    table.add_column("unit")
    for column in (UNSHADED, SHADED if shaded else None, "± (1 sd)"):
        if column is not None:
            table.add_column(column, justify="right")
    if truth:
        table.add_column("truth", justify="right")
        table.add_column("error", justify="right")
    group = None
    for final in result.measurements:
        if group not in (None, group_of(final.name)):
            table.add_section()
        group = group_of(final.name)
        earlier = unshaded.get(final.name, final.value)
        row = [final.name.replace("_", " "), final.unit, f"{earlier:.1f}"]
        if shaded:
            row.append(f"{final.value:.1f}")
        row.append(_spread(final))
        if truth:
            true = truth.get(final.name)
            row += ["", ""] if true is None else [f"{true:.1f}", f"{final.value - true:+.1f}"]
        table.add_row(*row)
    return table
