"""What the command line shows: a line when a stage begins, a table of measurements afterwards."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Final

from api_schemas.problems import Problem
from api_schemas.results import Assumption, Finding, FitResult, FitWarning
from fitter.vocabulary.outcomes import Severity

UNSHADED: Final = "SE"
WITHHELD: Final = 'Measurements are withheld; with "force": true in the request they are given.'


class Stages:
    """Tells each stage of a fit as it begins."""

    def __init__(self) -> None:
        self._stage: str | None = None

    def show(self, stage: str | None, share: float) -> None:
        """Take a report: the stage, and the share of the whole fit done."""
        if stage is not None and stage != self._stage:
            self._stage = stage
            print(f"{share:4.0%}  {stage.replace('_', ' ')}", flush=True)


def print_problem(problem: Problem) -> None:
    """Say what is wrong and what to do."""
    print(problem.title)
    for error in problem.errors:
        print(f"  {error.field}: {error.reason} {error.remedy}")
    if not problem.errors:
        print(f"  {problem.detail} {problem.remedy}")


def print_result(result: FitResult, *, truth: Mapping[str, float] | None = None) -> None:
    """Print the measurements by SE and in the end, next to the truth if there is one; remarks."""
    for line in _table(result, truth or {}) if result.measurements else (WITHHELD,):
        print(line)
    print(f"Verdict: {result.verdict} ({result.outcome_explanation})")
    for number, view in enumerate(result.views):
        shown = "" if view.view is None else f", {view.view}"
        print(
            f"View {number}{shown}: {view.outcome}, {view.verdict}. "
            f"Silhouette overlap {view.silhouette_overlap:.3f}."
        )
        _print_findings(view.findings)
        _print_remarks(view.assumptions, view.warnings)
    if result.agreement is not None:
        print(f"Agreement of the views {result.agreement:.2f}.")
    print(f"{result.evaluations} evaluations, {sum(result.stage_seconds.values()):.1f} s.")
    _print_remarks(result.assumptions, result.warnings)


def _table(result: FitResult, truth: Mapping[str, float]) -> Iterator[str]:
    unshaded = {
        each.name: each.value
        for stage in result.stages
        if stage.name == UNSHADED
        for each in stage.measurements
    }
    yield f"Measurements, {result.gender}, {result.height_m:.3f} m"
    yield f"{'':34}{'SE':>8}{result.cues:>8}{'± (1 sd)':>10}" + (
        "   truth   error" if truth else ""
    )
    for final in result.measurements:
        name = f"{final.name.replace('_', ' ')}, {final.unit}"
        spread = "" if final.standard_error is None else f"{final.standard_error:.1f}"
        line = f"{name:34}{unshaded.get(final.name, final.value):8.1f}{final.value:8.1f}"
        line += f"{'given' if final.given and spread == '0.0' else spread:>10}"
        if final.name in truth:
            line += f"{truth[final.name]:8.1f}{final.value - truth[final.name]:+8.1f}"
        yield line


def _print_findings(findings: Iterable[Finding]) -> None:
    """What blocks is told by the outcome."""
    for each in findings:
        if each.severity is not Severity.BLOCKS:
            print(f"{each.severity} ({each.code}): {each.reason} {each.remedy}")


def _print_remarks(assumptions: Iterable[Assumption], warnings: Iterable[FitWarning]) -> None:
    for assumption in assumptions:
        value = assumption.value
        shown = f"{value:.4g}" if isinstance(value, float) else value
        print(f"Assumed {assumption.quantity} = {shown}: {assumption.reason}")
    for warning in warnings:
        print(f"Warning ({warning.code}): {warning.message}")
