"""``maquette check``: say what is wrong with a picture, here and without a service."""

import importlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from rich.console import Console

from api_schemas.checks import CaptureCheck, CheckRequest
from service.commands.fit import UNUSABLE_INPUT, request_from_file
from service.commands.terminal import print_problem
from service.numerics.tasks import ProblemError
from service.settings import Settings
from service.submissions.refusal import RefusedError
from service.submissions.submission import placed_question
from service.submissions.validation import parsed

ANSWERS: Final = "service.estimates.answers"
"""Loads the numerics, so that it is imported once all else is known to be right."""

BLOCKED: Final = 1
"""Exit status if the picture is to be taken again."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckArguments:
    """The command line's arguments; ``said`` replaces fields of the points file."""

    image: Path
    points: Path | None
    said: Mapping[str, object]


def check_locally(arguments: CheckArguments, *, answers: str = ANSWERS) -> int:
    """Check a picture and print what was found; return the exit status."""
    console = Console()
    try:
        check = _check(arguments, answers)
    except OSError as error:
        console.print(f"[bold red]{error.strerror}:[/] {error.filename}")
        return UNUSABLE_INPUT
    except (RefusedError, ProblemError) as error:
        print_problem(console, error.problem)
        return UNUSABLE_INPUT
    _print_check(console, check)
    return 0 if check.usable else BLOCKED


def _check(arguments: CheckArguments, answers: str) -> CaptureCheck:
    settings = Settings()
    text = json.dumps(arguments.said).encode()
    if arguments.points is not None:
        text = request_from_file(arguments.points.read_text(), arguments.said, kind=CheckRequest)
    asked = parsed(CheckRequest, text, whole="request", called="the request")
    image = arguments.image.read_bytes()
    placed = placed_question(asked, image, max_pixels=settings.max_pixels)
    return importlib.import_module(answers).check(
        placed, image, max_pixels=settings.max_pixels, detector=settings.detector_dir
    )


def _print_check(console: Console, check: CaptureCheck) -> None:
    for found in check.findings:
        console.print(
            f"{found.severity} ({found.code}): {found.reason} {found.remedy}", markup=False
        )
    for each in check.not_checked:
        console.print(f"not checked ({each.code}): {each.reason}", markup=False)
    for assumption in check.assumptions:
        console.print(f"Assumed {assumption.quantity}: {assumption.reason}", markup=False)
    for warning in check.warnings:
        console.print(f"Warning ({warning.code}): {warning.message}", markup=False)
    if not check.findings:
        console.print("Nothing was found to be wrong.")
    console.print("The picture is usable." if check.usable else "Take the picture again.")
