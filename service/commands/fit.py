"""``maquette fit``: fit one picture locally, with the service's checks and pipeline."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, cast

from pydantic import BaseModel
from rich.console import Console

from api_schemas.points import AUTO
from api_schemas.problems import Problem, problem
from api_schemas.requests import FitOptions, FitRequest
from service.commands.local_work import UNUSABLE_INPUT, fitted, told, write_result
from service.jobs.inputs import SentPicture
from service.submissions.refusal import RefusedError
from service.submissions.validation import parsed
from service.worker.pipeline_port import PipelineOutput

PIPELINE: Final = "service.worker.pipeline"


@dataclass(frozen=True, slots=True, kw_only=True)
class FitArguments:
    """The command line's arguments; ``overrides`` replace fields of the points file.

    Without a ``points`` file all points are proposed.
    ``models`` is the folder of the body models, None for the service's setting; ``formats`` are the
    endings of what meshes are written as beside GLB.
    """

    image: Path
    points: Path | None
    mask: Path | None
    models: Path | None
    output: Path
    overrides: Mapping[str, object]
    formats: tuple[str, ...] = ()


def request_from_file(
    text: str, overrides: Mapping[str, object], *, kind: type[BaseModel] = FitOptions
) -> bytes:
    """Extract the fields of a request from a points file, which may hold other things as well.

    Raises
    ------
    RefusedError
        If the text is not a JSON object.
    """
    values = values_from_file(text)
    known = {name: value for name, value in values.items() if name in kind.model_fields}
    return json.dumps(known | dict(overrides)).encode()


def values_from_file(text: str) -> dict[str, Any]:
    """Read a points file.

    Raises
    ------
    RefusedError
        If the text is not a JSON object.
    """
    try:
        values = json.loads(text)
    except json.JSONDecodeError as error:
        raise RefusedError(_unreadable(str(error))) from error
    if not isinstance(values, dict):
        raise RefusedError(_unreadable("it is no object"))
    return cast("dict[str, Any]", values)


def fit_locally(arguments: FitArguments, *, pipeline: str = PIPELINE) -> int:
    """Fit, write all files to the output folder, print the measurements; return the exit status."""
    console = Console()
    output = told(console, lambda: _fit(console, arguments, pipeline=pipeline))
    if output is None:
        return UNUSABLE_INPUT
    write_result(console, output, arguments.output, formats=arguments.formats)
    return 0


def _fit(console: Console, arguments: FitArguments, *, pipeline: str) -> PipelineOutput:
    asked = parsed(FitRequest, fit_request(arguments), whole="request", called="what is asked for")
    mask = None if arguments.mask is None else arguments.mask.read_bytes()
    picture = SentPicture(arguments.image.read_bytes(), mask)
    return fitted(console, asked, [picture], models=arguments.models, pipeline=pipeline)


def fit_request(arguments: FitArguments) -> bytes:
    """The request that the arguments and the points file make together."""
    if arguments.points is None:
        return json.dumps({"points": AUTO} | dict(arguments.overrides)).encode()
    return request_from_file(arguments.points.read_text(), arguments.overrides)


def _unreadable(why: str) -> Problem:
    return problem(
        "malformed-request",
        detail=f"The points file cannot be read: {why}.",
        remedy='Give a JSON file with an object {"points": {"left_shoulder": [x, y], ...}}.',
        field="points",
    )
