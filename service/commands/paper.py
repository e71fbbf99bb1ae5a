"""``maquette paper``: the paper's figures and its table, drawn from fits made here and now."""

import io
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

from api_schemas.fit import FitRequest
from fitter import request as fitter_request
from fitter.applications.motion_file import read_motion
from fitter.errors import InvalidInputError
from fitter.export.display import png
from fitter.reproduction.drawing import (
    PRINTED_TABLE,
    Pictures,
    Reproduction,
    index_html,
    reproduce,
    table_csv,
)
from fitter.reproduction.panels import Figure
from fitter.reproduction.subject import PosedTruth, Subject
from service.commands.fit import UNUSABLE_INPUT, read_request, told
from service.compute import translate
from service.compute.pipeline_port import UnusableInputError
from service.demo_data.sample import load_sample, load_subject
from service.jobs.inputs import SentPicture
from service.process.caches import settle_folders
from service.settings import Settings
from service.submissions.submission import check_submission

_HIDING: Final = "occluded"
"""The subject's pose in which an arm hides part of the trunk."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PaperArguments:
    """The command line's arguments: what takes the place of the packaged pictures, and is added.

    ``picture`` and ``painting`` are each a picture and a file with its request.
    """

    output: Path
    picture: tuple[Path, Path] | None = None
    painting: tuple[Path, Path] | None = None
    motion: Path | None = None


def draw_paper(arguments: PaperArguments, settings: Settings) -> int:
    """Draw all figures into the output folder, with a page of them; return the exit status."""
    drawn = told(lambda: _drawn(arguments, settings))
    if drawn is None:
        return UNUSABLE_INPUT
    (arguments.output / "index.html").write_text(index_html(drawn))
    (arguments.output / "table_1.csv").write_text(table_csv((*drawn.tables, PRINTED_TABLE)))
    print(f"{arguments.output / 'index.html'} shows them all.")
    return 0


def packaged_pictures(settings: Settings) -> Pictures:
    """Those that ship with the package, without a painting."""
    sample, subject = load_sample(), load_subject()
    with np.load(io.BytesIO(subject.bodies), allow_pickle=False) as bodies:
        step_m = float(bodies["step_m"])
        true = {name: step_m * bodies[name] for name in ("canonical", *subject.pictures)}
    return Pictures(
        portrait=_request(sample.image, _packaged(sample.request), settings),
        subject=Subject(
            pictures=tuple(
                PosedTruth(
                    name=name,
                    request=_request(picture.image, _packaged(picture.request), settings),
                    posed=true[name],
                )
                for name, picture in subject.pictures.items()
            ),
            canonical=true["canonical"],
            measurements=subject.measurements,
        ),
        hiding=list(subject.pictures).index(_HIDING),
    )


def _drawn(arguments: PaperArguments, settings: Settings) -> Reproduction:
    settle_folders()
    pictures = packaged_pictures(settings)
    given = {
        name: _request(image.read_bytes(), read_request(request), settings)
        for name, files in (("portrait", arguments.picture), ("painting", arguments.painting))
        if files is not None
        for image, request in [files]
    }
    pictures = replace(pictures, **given)
    arguments.output.mkdir(parents=True, exist_ok=True)

    def keep(figure: Figure) -> None:
        path = arguments.output / f"{figure.name}.png"
        path.write_bytes(png(figure.picture))
        print(f"{path}: {figure.title}")

    try:
        if arguments.motion is not None:
            pictures = replace(pictures, motion=read_motion(arguments.motion.read_bytes()))
        return reproduce(pictures, keep)
    except InvalidInputError as error:
        raise UnusableInputError(translate.field_problem(error)) from error


def _packaged(request: bytes) -> FitRequest:
    return FitRequest.model_validate_json(request)


def _request(picture: bytes, asked: FitRequest, settings: Settings) -> fitter_request.FitRequest:
    """Check a request as the service does, and translate it."""
    sent = [SentPicture(picture, None)]
    checked = check_submission(asked, sent, max_pixels=settings.max_pixels)
    return translate.fit_request(checked.request, sent, max_pixels=settings.max_pixels)
