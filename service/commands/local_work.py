"""What commands have in common that work on pictures here and now: a fit, its faults and files."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Final, TypeVar

from rich.console import Console

from api_schemas.problems import field_problem
from api_schemas.requests import FitRequest
from api_schemas.scans import ScanRequest
from fitter.errors import ModelFileError
from service.commands.terminal import print_problem, print_result, stage_bars
from service.engine.port import Report
from service.jobs.inputs import SentPicture
from service.process.caches import settle_folders
from service.representation.csv_tables import TABLE, measurements_csv
from service.representation.formats import GLB_ENDING
from service.settings import Settings
from service.submissions.detector import check_detector
from service.submissions.refusal import RefusedError
from service.submissions.submission import check_submission
from service.worker.artifacts import with_result_document
from service.worker.pipeline_port import (
    PipelineInput,
    PipelineOutput,
    UnusableInputError,
    load_pipeline,
)

UNUSABLE_INPUT: Final = 2
"""Exit status if the input is at fault, as for wrong arguments."""

Made = TypeVar("Made")


def told(console: Console, work: Callable[[], Made]) -> Made | None:
    """Do the work; where the input is at fault, print that and return None."""
    try:
        return work()
    except ModelFileError as error:
        console.print(f"[bold red]The body model cannot be used.[/] {error}", highlight=False)
    except OSError as error:
        console.print(f"[bold red]{error.strerror}:[/] {error.filename}")
    except RefusedError as error:
        print_problem(console, error.problem)
    except UnusableInputError as error:
        print_problem(console, field_problem("unusable-input", error.error))
    return None


def fitted(
    console: Console,
    asked: FitRequest | ScanRequest,
    pictures: Sequence[SentPicture[bytes]],
    *,
    models: Path | None,
    pipeline: str,
) -> PipelineOutput:
    """Check and fit as the service does, and show how far it is.

    Raises
    ------
    RefusedError, UnusableInputError, ModelFileError
        As :func:`service.submissions.submission.check_submission` and the pipeline do.
    """
    settle_folders()
    settings = Settings()
    checked = check_submission(asked, pictures, max_pixels=settings.max_pixels)
    check_detector(checked.options, settings.detector_dir)
    with stage_bars(console) as bars:
        output = load_pipeline(pipeline).run(
            PipelineInput(
                options=checked.options,
                pictures=tuple(pictures),
                max_pixels=settings.max_pixels,
                models=models or settings.models_dir,
                detector=settings.detector_dir,
            ),
            lambda report: bars.show(_stage(report), report.progress),
        )
        bars.finish()
    return output


def _stage(report: Report) -> str:
    return report.stage if report.view is None else f"view {report.view}: {report.stage}"


def write_result(
    console: Console, output: PipelineOutput, folder: Path, *, formats: Sequence[str]
) -> None:
    """Write all files, meshes in these formats too, and the table; and print the result."""
    documents = with_result_document(output.result, output.artifacts)
    files = documents | _in_formats(documents, formats)
    files[TABLE] = measurements_csv(output.result.measurements)
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in files.items():
        (folder / name).write_bytes(content)
    print_result(console, output.result)
    console.print(f"{len(files)} files lie in {folder}.", highlight=False)


def _in_formats(files: Mapping[str, bytes], formats: Sequence[str]) -> dict[str, bytes]:
    """Every mesh in every one of the formats, by file name."""
    if not formats:
        return {}
    # Imported here: its libraries take a moment to load, and most fits do not need them.
    from fitter.export.formats import converted

    return {
        f"{name.removesuffix(GLB_ENDING)}.{ending}": converted(content, ending)
        for name, content in files.items()
        if name.endswith(GLB_ENDING)
        for ending in formats
    }
