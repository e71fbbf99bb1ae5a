"""``maquette fit``: fit pictures here and now, with the service's checks and pipeline."""

import argparse
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Final, TypeVar

from api_schemas.csv_tables import TABLE, measurements_csv
from api_schemas.fit import FitRequest
from api_schemas.problems import Problem, field_problem
from api_schemas.results import FitResult
from fitter.errors import ModelFileError
from fitter.vocabulary.remarks import Remark, Severity
from service.compute.kernels import settle_folders
from service.compute.tasks import OPTIONS, Parts, UnusableInputError, child_setup, load_tasks
from service.jobs.inputs import RESULT, SentPicture, named_pictures
from service.jobs.records import FIT, Report
from service.settings import Settings
from service.startup import UNUSABLE, run_command
from service.submissions.refusal import RefusedError, parsed
from service.submissions.submission import check_detector, check_submission

PIPELINE: Final = "service.compute.pipeline"
UNSHADED: Final = "SE"
WITHHELD: Final = 'Measurements are withheld; with "force": true in the request they are given.'

INPUT_FAULTS: Final = (ModelFileError, OSError, RefusedError, UnusableInputError)

Made = TypeVar("Made")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """A request, its pictures, and where the files go."""
    parser.add_argument(
        "request", type=Path, metavar="REQUEST", help="JSON, as POST /v1/fits takes it"
    )
    parser.add_argument(
        "pictures",
        type=Path,
        nargs="+",
        metavar="PICTURE",
        help="one to six, in the order of the request's views: JPEG, PNG, WebP or HEIC",
    )
    add_output(parser, Path("maquette-fit"))


def add_output(parser: argparse.ArgumentParser, default: Path) -> None:
    """The folder that files are written to."""
    parser.add_argument(
        "--output", type=Path, default=default, metavar="DIR", help="default: %(default)s"
    )


def run(parsed: argparse.Namespace) -> int:
    """Fit what the command line names."""
    return run_command("fit", lambda _: fit_locally(parsed.request, parsed.pictures, parsed.output))


def fit_locally(
    request: Path, pictures: Sequence[Path], output: Path, *, pipeline: str = PIPELINE
) -> int:
    """Fit, write all files to a folder, print the measurements; return the exit status."""
    made = told(
        lambda: fitted(
            parsed(FitRequest, request.read_bytes(), whole=request.name, called=request.name),
            [SentPicture(picture.read_bytes(), None) for picture in pictures],
            pipeline=pipeline,
        )
    )
    if made is None:
        return UNUSABLE
    result, files = made
    files = {**files, TABLE: measurements_csv(result.measurements)}
    for name, content in files.items():
        path = output / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    print_result(result)
    print(f"{len(files)} files lie in {output}.")
    return 0


def told(work: Callable[[], Made]) -> Made | None:
    """Do the work; where the input is at fault, print that and return None."""
    try:
        return work()
    except INPUT_FAULTS as error:
        print("\n".join(fault_lines(error)))
        return None


def fault_lines(error: Exception) -> list[str]:
    """Say what one of ``INPUT_FAULTS`` means and what to do."""
    if isinstance(error, RefusedError):
        return problem_lines(error.problem)
    if isinstance(error, UnusableInputError):
        return problem_lines(field_problem("unusable-input", error.error))
    if isinstance(error, OSError):
        return [f"{error.strerror}: {error.filename}"]
    return [f"The body model cannot be used. {error}"]


def problem_lines(problem: Problem) -> list[str]:
    """Say what is wrong and what to do."""
    told = [f"  {each.field}: {each.reason} {each.remedy}" for each in problem.errors]
    return [problem.title, *(told or [f"  {problem.detail} {problem.remedy}"])]


def fitted(
    asked: FitRequest,
    pictures: Sequence[SentPicture[bytes]],
    *,
    pipeline: str = PIPELINE,
) -> tuple[FitResult, Parts]:
    """Check and fit as the service does, show how far it is; return result and files by name.

    Raises
    ------
    RefusedError, UnusableInputError, ModelFileError
        As :func:`service.submissions.submission.check_submission` and the pipeline do.
    """
    settle_folders()
    settings = Settings()
    checked = check_submission(asked, pictures, max_pixels=settings.max_pixels)
    check_detector(checked.request, settings.detector_dir)
    stages = Stages()
    setup = child_setup(settings, name="fit", tasks=pipeline)
    parts = {OPTIONS: checked.request.model_dump_json().encode(), **named_pictures(pictures)}
    files = load_tasks(pipeline)[FIT](
        setup, parts, lambda report: stages.show(_stage(report), report.progress)
    )
    return FitResult.model_validate_json(files[RESULT]), files


def _stage(report: Report) -> str:
    return report.stage if report.view is None else f"view {report.view}: {report.stage}"


class Stages:
    """Tells each stage of a fit as it begins."""

    def __init__(self) -> None:
        self._stage: str | None = None

    def show(self, stage: str | None, share: float) -> None:
        """Take a report: the stage, and the share of the whole fit done."""
        if stage is not None and stage != self._stage:
            self._stage = stage
            print(f"{share:4.0%}  {stage.replace('_', ' ')}", flush=True)


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
        _print_remarks((*view.findings, *view.assumptions, *view.warnings))
    if result.agreement is not None:
        print(f"Agreement of the views {result.agreement:.2f}.")
    print(f"{result.evaluations} evaluations, {sum(result.stage_seconds.values()):.1f} s.")
    _print_remarks((*result.assumptions, *result.warnings))


def _table(result: FitResult, truth: Mapping[str, float]) -> Iterator[str]:
    unshaded = next((stage.measurements for stage in result.stages if stage.name == UNSHADED), {})
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


def _print_remarks(remarks: Iterable[Remark]) -> None:
    """Print all remarks but those that block, which the outcome tells."""
    for each in remarks:
        if each.severity is not Severity.BLOCKS:
            print(f"{each.severity} ({each.code}): {each.text}")
