"""The pictures of the report: copies of the fit's own, and the body from four sides."""

import io
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from PIL import Image

from fitter.arrays import Points2D
from fitter.export.display import png
from fitter.export.views import sides_pictures
from service.jobs.inputs import OVERLAY, PERSON
from service.worker.derived.person import person_and_operators
from service.worker.derived.report.tape_drawing import Tag, TapeDrawing
from service.worker.derived.report.wording import PictureWords

LONGEST_SIDE_PX: Final = 1_400
"""Size of the photograph: 300 dots per inch on the page, in a file small enough to send."""

JPEG_QUALITY: Final = 88


@dataclass(frozen=True, slots=True, kw_only=True)
class Picture:
    """An encoded picture and what it shows."""

    caption: str
    media_type: str
    content: bytes
    width: int
    height: int


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TapePicture:
    """A picture of the body with lines and numbers to be drawn over it, in its pixels.

    ``lines`` are of the tapes that ``tags`` number, ``others`` of tapes numbered elsewhere.
    """

    picture: Picture
    lines: tuple[Points2D, ...]
    others: tuple[Points2D, ...]
    tags: tuple[Tag, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class ReportPictures:
    """All pictures of the page.

    ``sides`` are the body from four sides, ``tapes`` its sides with tapes, in one scale, and none
    where measurements are withheld.
    """

    overlay: Picture
    sides: tuple[Picture, ...]
    tapes: tuple[TapePicture, ...] = ()


def report_pictures(
    inputs: Mapping[str, bytes],
    drawing: TapeDrawing | None,
    *,
    words: PictureWords,
    models: Path | None,
) -> ReportPictures:
    """Collect the pictures from the fit's files.

    Parameters
    ----------
    inputs
        The derivation's inputs by name.
    drawing
        Where the measurements are taken.
    words
        The captions.
    models
        Folder with the body models, None for those shipped with the package.

    Raises
    ------
    InvalidInputError
        If the person was fitted with a different body model from the current one.
    """
    return ReportPictures(
        overlay=_photograph(inputs[OVERLAY], words.overlay),
        sides=_sides(inputs[PERSON], words, models),
        tapes=() if drawing is None else _tapes(drawing, words),
    )


def _tapes(drawing: TapeDrawing, words: PictureWords) -> tuple[TapePicture, ...]:
    return tuple(
        TapePicture(
            picture=_photograph(png(panel.view.picture), words.tape_sides[panel.view.side]),
            lines=panel.lines,
            others=panel.others,
            tags=panel.tags,
        )
        for panel in drawing.panels
    )


def _sides(person_file: bytes, words: PictureWords, models: Path | None) -> tuple[Picture, ...]:
    person, operators = person_and_operators(person_file, models)
    sides = sides_pictures(
        operators.evaluator.vertices(person.body),
        person.body.translation,
        person.tilt,
        operators.model.triangles,
    )
    return tuple(_drawing(png(levels), words.sides[side]) for side, levels in sides.items())


def _drawing(content: bytes, caption: str) -> Picture:
    """A PNG compressed as far as possible: the fit's own are compressed fast."""
    with Image.open(io.BytesIO(content)) as opened:
        stream = io.BytesIO()
        opened.save(stream, "PNG", optimize=True)
        return _picture(stream, caption, "image/png", opened.size)


def _photograph(content: bytes, caption: str) -> Picture:
    with Image.open(io.BytesIO(content)) as opened:
        shown = opened.convert("RGB")
    shown.thumbnail((LONGEST_SIDE_PX, LONGEST_SIDE_PX))
    stream = io.BytesIO()
    shown.save(stream, "JPEG", quality=JPEG_QUALITY, optimize=True)
    return _picture(stream, caption, "image/jpeg", shown.size)


def _picture(stream: io.BytesIO, caption: str, media_type: str, size: tuple[int, int]) -> Picture:
    width, height = size
    return Picture(
        caption=caption,
        media_type=media_type,
        content=stream.getvalue(),
        width=width,
        height=height,
    )
