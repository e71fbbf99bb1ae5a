"""``maquette fit``: fit pictures here and now, with the service's checks and pipeline."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final, TypeVar

from api_schemas.fit import FitRequest
from api_schemas.problems import field_problem
from fitter.errors import ModelFileError
from service.commands.terminal import Stages, print_problem, print_result
from service.compute.files import with_result_document
from service.compute.pipeline_port import (
    PipelineInput,
    PipelineOutput,
    UnusableInputError,
    load_pipeline,
)
from service.jobs.inputs import SentPicture
from service.jobs.records import Report
from service.process.caches import settle_folders
from service.representation.csv_tables import TABLE, measurements_csv
from service.representation.formats import GLB_ENDING
from service.settings import Settings
from service.submissions.refusal import RefusedError, parsed
from service.submissions.submission import check_detector, check_submission

PIPELINE: Final = "service.compute.pipeline"
UNUSABLE_INPUT: Final = 2
"""Exit status if the input is at fault, as for wrong arguments."""

Made = TypeVar("Made")


@dataclass(frozen=True, slots=True, kw_only=True)
class FitArguments:
    """The command line's arguments.

    ``request`` is a file with a :class:`~api_schemas.fit.FitRequest` as JSON; ``masks`` are none or
    as many as pictures; ``formats`` are the endings of what meshes are written as beside GLB.
    """

    request: Path
    pictures: Sequence[Path]
    output: Path
    masks: Sequence[Path] = ()
    formats: Sequence[str] = ()


def fit_locally(arguments: FitArguments, *, pipeline: str = PIPELINE) -> int:
    """Fit, write all files to the output folder, print the measurements; return the exit status."""
    output = told(lambda: _fit(arguments, pipeline=pipeline))
    if output is None:
        return UNUSABLE_INPUT
    _write_result(output, arguments.output, formats=arguments.formats)
    return 0


def _fit(arguments: FitArguments, *, pipeline: str) -> PipelineOutput:
    asked = read_request(arguments.request)
    masks = [mask.read_bytes() for mask in arguments.masks] or [None] * len(arguments.pictures)
    pictures = [
        SentPicture(picture.read_bytes(), mask)
        for picture, mask in zip(arguments.pictures, masks, strict=True)
    ]
    return fitted(asked, pictures, pipeline=pipeline)


def read_request(file: Path) -> FitRequest:
    """Read a request from a file.

    Raises
    ------
    RefusedError
        If it is not of this type.
    """
    return parsed(FitRequest, file.read_bytes(), whole=file.name, called=file.name)


def told(work: Callable[[], Made]) -> Made | None:
    """Do the work; where the input is at fault, print that and return None."""
    try:
        return work()
    except ModelFileError as error:
        print(f"The body model cannot be used. {error}")
    except OSError as error:
        print(f"{error.strerror}: {error.filename}")
    except RefusedError as error:
        print_problem(error.problem)
    except UnusableInputError as error:
        print_problem(field_problem("unusable-input", error.error))
    return None


def fitted(
    asked: FitRequest,
    pictures: Sequence[SentPicture[bytes]],
    *,
    pipeline: str = PIPELINE,
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
    check_detector(checked.request, settings.detector_dir)
    stages = Stages()
    return load_pipeline(pipeline).run(
        PipelineInput(
            request=checked.request,
            pictures=tuple(pictures),
            max_pixels=settings.max_pixels,
            models=settings.models_dir,
            detector=settings.detector_dir,
        ),
        lambda report: stages.show(_stage(report), report.progress),
    )


def _stage(report: Report) -> str:
    return report.stage if report.view is None else f"view {report.view}: {report.stage}"


def _write_result(output: PipelineOutput, folder: Path, *, formats: Sequence[str]) -> None:
    """Write all files, meshes in these formats too, and the table; and print the result."""
    documents = with_result_document(output.result, output.files)
    files = documents | _in_formats(documents, formats)
    files[TABLE] = measurements_csv(output.result.measurements)
    for name, content in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    print_result(output.result)
    print(f"{len(files)} files lie in {folder}.")


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
