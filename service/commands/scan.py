"""``maquette scan``: measure one person from several pictures, with the service's checks."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from rich.console import Console

from api_schemas.points import AUTO
from api_schemas.requests import PersonChoices
from api_schemas.scans import ScanRequest, ScanViewRequest
from fitter.vocabulary.choices import ViewKind
from service.commands.fit import PIPELINE, values_from_file
from service.commands.local_work import UNUSABLE_INPUT, fitted, told, write_result
from service.jobs.inputs import SentPicture
from service.submissions.validation import parsed
from service.worker.pipeline_port import PipelineOutput

VIEWS: Final = (ViewKind.FRONT, ViewKind.SIDE)
"""What the first pictures show unless it is said; those after them are ``other``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ScanArguments:
    """The command line's arguments; ``overrides`` replace fields of the first points file.

    ``views`` and ``points`` are those of the pictures in their order: None where all points are
    proposed. What is missing at their ends is as usual. ``of_all_views`` is said of every picture.
    """

    images: Sequence[Path]
    views: Sequence[str]
    points: Sequence[Path | None]
    models: Path | None
    output: Path
    overrides: Mapping[str, object]
    of_all_views: Mapping[str, object]
    formats: tuple[str, ...] = ()


def scan_locally(arguments: ScanArguments, *, pipeline: str = PIPELINE) -> int:
    """Measure, write all files to the output folder, print; return the exit status."""
    console = Console()
    output = told(console, lambda: _scan(console, arguments, pipeline=pipeline))
    if output is None:
        return UNUSABLE_INPUT
    write_result(console, output, arguments.output, formats=arguments.formats)
    return 0


def _scan(console: Console, arguments: ScanArguments, *, pipeline: str) -> PipelineOutput:
    asked = parsed(
        ScanRequest, scan_request(arguments), whole="request", called="what is asked for"
    )
    pictures = [SentPicture(path.read_bytes(), None) for path in arguments.images]
    return fitted(console, asked, pictures, models=arguments.models, pipeline=pipeline)


def scan_request(arguments: ScanArguments) -> bytes:
    """The request that the arguments and the points files make together."""
    pictures = range(len(arguments.images))
    said = [_said_of(arguments.points, number) for number in pictures]
    person = {name: each for name, each in said[0].items() if name in PersonChoices.model_fields}
    kinds = [*arguments.views, *VIEWS[len(arguments.views) :]]
    views = [
        {name: each for name, each in said[number].items() if name in _OF_A_VIEW}
        | dict(arguments.of_all_views)
        | {"view": kinds[number] if number < len(kinds) else ViewKind.OTHER.value}
        for number in pictures
    ]
    return json.dumps(person | dict(arguments.overrides) | {"views": views}).encode()


_OF_A_VIEW: Final = frozenset(ScanViewRequest.model_fields) - {"view"}


def _said_of(points: Sequence[Path | None], number: int) -> dict[str, Any]:
    file = points[number] if number < len(points) else None
    return {"points": AUTO} if file is None else values_from_file(file.read_text())
