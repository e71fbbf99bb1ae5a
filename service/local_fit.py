"""``maquette fit``: one picture here and now, through the same checks and the same pipeline."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from rich.console import Console

from api_schemas.derivations import CaricatureOptions
from api_schemas.problems import Problem, field_problem, problem
from api_schemas.requests import FitOptions
from fitter.errors import ModelFileError
from service.demo_sample import load_sample
from service.inputs import PERSON
from service.refusal import RefusedError
from service.settings import Settings
from service.submission import check_submission
from service.terminal import print_problem, print_result, stage_bars
from service.worker.artifacts import with_result_document
from service.worker.pipeline_port import (
    DerivationInput,
    PipelineInput,
    PipelineOutput,
    UnusableInputError,
    load_pipeline,
)

PIPELINE: Final = "service.worker.pipeline"
UNUSABLE_INPUT: Final = 2
"""Exit status when the input is at fault, as for wrong arguments."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FitArguments:
    """What the command line says; ``overrides`` replace what the points file says.

    ``models`` is the folder of the body models, None for the service's setting.
    """

    image: Path
    points: Path
    mask: Path | None
    models: Path | None
    output: Path
    overrides: Mapping[str, object]


def request_from_file(text: str, overrides: Mapping[str, object]) -> bytes:
    """Take the fields of a request out of a points file, which may hold other things besides.

    Raises
    ------
    RefusedError
        If the text is no JSON object.
    """
    try:
        values = json.loads(text)
    except json.JSONDecodeError as error:
        raise RefusedError(_unreadable(str(error))) from error
    if not isinstance(values, dict):
        raise RefusedError(_unreadable("it is no object"))
    known = {name: value for name, value in values.items() if name in FitOptions.model_fields}
    return json.dumps(known | dict(overrides)).encode()


def fit_locally(arguments: FitArguments, *, pipeline: str = PIPELINE) -> int:
    """Fit, write all files to the output folder, print the measurements; return the exit status."""
    console = Console()
    try:
        request = request_from_file(arguments.points.read_text(), arguments.overrides)
        image = arguments.image.read_bytes()
        mask = None if arguments.mask is None else arguments.mask.read_bytes()
        output = _fit(
            console,
            request=request,
            image=image,
            mask=mask,
            models=arguments.models,
            pipeline=pipeline,
        )
    except ModelFileError as error:
        console.print(f"[bold red]The body model cannot be used.[/] {error}", highlight=False)
        return UNUSABLE_INPUT
    except OSError as error:
        console.print(f"[bold red]{error.strerror}:[/] {error.filename}")
        return UNUSABLE_INPUT
    except RefusedError as error:
        print_problem(console, error.problem)
        return UNUSABLE_INPUT
    except UnusableInputError as error:
        print_problem(console, field_problem("unusable-input", error.error))
        return UNUSABLE_INPUT
    arguments.output.mkdir(parents=True, exist_ok=True)
    files = with_result_document(output.result, output.artifacts)
    for name, content in files.items():
        (arguments.output / name).write_bytes(content)
    print_result(console, output.result)
    console.print(f"{len(files)} files lie in {arguments.output}.", highlight=False)
    return 0


def warm_up(*, pipeline: str = PIPELINE) -> int:
    """Fit the sample and exaggerate it, so that what is compiled at first use is compiled."""
    console = Console()
    sample = load_sample()
    output = _fit(
        console,
        request=sample.request,
        image=sample.image,
        mask=None,
        models=None,
        pipeline=pipeline,
    )
    if PERSON in output.artifacts:
        # A caricature asks where a surface runs through itself, which no fit does.
        settings = Settings()
        load_pipeline(pipeline).derive(
            DerivationInput(
                options=CaricatureOptions(kind="caricature", factor=1.1),
                inputs={PERSON: output.artifacts[PERSON]},
                max_pixels=settings.max_pixels,
                models=settings.models_dir,
            ),
            lambda _: None,
        )
    return 0


def _fit(
    console: Console,
    *,
    request: bytes,
    image: bytes,
    mask: bytes | None,
    models: Path | None,
    pipeline: str,
) -> PipelineOutput:
    settings = Settings()
    checked = check_submission(
        request=request, image=image, mask=mask, max_pixels=settings.max_pixels
    )
    with stage_bars(console) as bars:
        output = load_pipeline(pipeline).run(
            PipelineInput(
                options=checked.options,
                image=image,
                mask=mask,
                max_pixels=settings.max_pixels,
                models=models or settings.models_dir,
            ),
            lambda report: bars.show(report.stage, report.progress),
        )
        bars.finish()
    return output


def _unreadable(why: str) -> Problem:
    return problem(
        "malformed-request",
        detail=f"The points file cannot be read: {why}.",
        remedy='Give a JSON file with an object {"points": {"left_shoulder": [x, y], ...}}.',
        field="points",
    )
