"""``maquette paper``: the paper's figures and its table, drawn from fits made here and now."""

import argparse
import json
from pathlib import Path
from typing import Final

import numpy as np

from api_schemas.fit import FitRequest
from fitter import request as fitter_request
from fitter.errors import InvalidInputError
from fitter.export.display import png
from fitter.reproduction.drawing import Subject, reproduce, table_markdown
from fitter.reproduction.panels import Figure
from service.commands.fit import add_output, told
from service.compute import translate
from service.compute.kernels import settle_folders
from service.compute.tasks import UnusableInputError
from service.demo_data.sample import FOLDER, load_sample
from service.jobs.inputs import SentPicture
from service.settings import Settings
from service.startup import UNUSABLE, run_command
from service.submissions.refusal import parsed
from service.submissions.submission import check_submission

_INTRODUCTION: Final = """# The paper, reproduced

The figures and the table of P. Guan, A. Weiss, A. O. Bălan and M. J. Black, Estimating Human Shape
and Pose from a Single Image, ICCV 2009, drawn from fits of this package. Pictures are rendered
people, but for a painting that was given.
"""
_TABLE_NOTE: Final = """## Table 1

In parentheses the deviation from the truth. The waist is the navel's. The paper's truth differs
from pose to pose, since it is a fit to each; here it is one body at rest.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """A painting, and where the figures go."""
    parser.add_argument(
        "--painting",
        type=Path,
        nargs=2,
        metavar=("PICTURE", "REQUEST"),
        help="of Fig. 10, with the JSON of its request",
    )
    add_output(parser, Path("maquette-paper"))


def run(parsed: argparse.Namespace) -> int:
    """Draw all figures into a folder, with a page of them."""

    def draw(settings: Settings) -> int:
        page = told(lambda: _drawn(parsed.output, parsed.painting, settings))
        if page is None:
            return UNUSABLE
        path = parsed.output / "index.md"
        path.write_text(page)
        print(f"{path} shows them all.")
        return 0

    return run_command("paper", draw)


def packaged_pictures(
    settings: Settings, folder: Path = FOLDER / "subject"
) -> tuple[fitter_request.FitRequest, Subject]:
    """The portrait and the subject that ship with the package.

    ``bodies.npz`` has the true vertices as whole numbers of ``step_m``: ``canonical`` at rest, and
    of each pose under its name, in the camera frame.
    """
    sample, document = load_sample(), json.loads((folder / "subject.json").read_text())
    asked = document["requests"]
    pictures = {name: folder / f"{name}.jpg" for name in asked}
    with np.load(folder / "bodies.npz", allow_pickle=False) as bodies:
        true = {name: float(bodies["step_m"]) * bodies[name] for name in ("canonical", *asked)}

    return _request(sample.image, sample.request, settings), Subject(
        requests={
            name: _request(picture.read_bytes(), json.dumps(asked[name]).encode(), settings)
            for name, picture in pictures.items()
        },
        posed={name: true[name] for name in asked},
        canonical=true["canonical"],
        measurements=document["measurements"],
    )


def _drawn(output: Path, painting: tuple[Path, Path] | None, settings: Settings) -> str:
    """A page of the figures, which lie beside it, and of the table."""
    settle_folders()
    portrait, subject = packaged_pictures(settings)
    given = None
    if painting is not None:
        picture, request = painting
        given = _request(picture.read_bytes(), request.read_bytes(), settings)
    output.mkdir(parents=True, exist_ok=True)
    parts = [_INTRODUCTION]

    def keep(figure: Figure) -> None:
        path = output / f"{figure.name}.png"
        path.write_bytes(png(figure.picture))
        parts.append(f"## {figure.title}\n\n![{figure.title}]({path.name})\n\n{figure.words}\n")
        print(f"{path}: {figure.title}")

    try:
        tables = reproduce(portrait, subject, keep, painting=given)
    except InvalidInputError as error:
        raise UnusableInputError(translate.field_problem(error)) from error
    return "\n".join([*parts, _TABLE_NOTE, *map(table_markdown, tables)])


def _request(picture: bytes, request: bytes, settings: Settings) -> fitter_request.FitRequest:
    """Check a request as the service does, and translate it."""
    sent = [SentPicture(picture, None)]
    asked = parsed(FitRequest, request, whole="request", called="request")
    checked = check_submission(asked, sent, max_pixels=settings.max_pixels)
    return translate.fit_request(checked.request, sent, max_pixels=settings.max_pixels)
