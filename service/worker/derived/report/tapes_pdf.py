"""The tapes on the body as vector drawings in the PDF."""

import io
from collections.abc import Callable
from typing import Final

from reportlab.lib.colors import Color, HexColor
from reportlab.lib.units import mm
from reportlab.lib.utils import ImageReader
from reportlab.pdfgen.canvas import Canvas

from fitter.arrays import Points2D
from service.worker.derived.report.pictures import TapePicture
from service.worker.derived.report.tape_drawing import TAG_PX, Tag

TAPE: Final = HexColor("#a2441f")
OTHER: Final = HexColor("#c9a48f")
INK: Final = HexColor("#1c1c1c")
PAPER: Final = HexColor("#ffffff")
TAPE_PX: Final = 4.0
OTHER_PX: Final = 2.0
NUMBER_PX: Final = 25.0
BASELINE_PX: Final = 9.0
"""From the middle of a number down to its baseline."""

CAPTION_HEIGHT: Final = 4.5 * mm
GAP: Final = 4 * mm


def draw_tapes(
    canvas: Canvas,
    panels: tuple[TapePicture, ...],
    box: tuple[float, float, float, float],
    *,
    caption: Callable[[Canvas, str, float, float], None],
) -> None:
    """Draw all sides in a row and in one scale, as large as the box (left, top, ...) allows.

    ``caption`` writes a text below a panel, given the panel's left and its lower edge.
    """
    left, top, width, height = box
    room = width - GAP * (len(panels) - 1)
    scale = min(
        room / sum(panel.picture.width for panel in panels),
        (height - CAPTION_HEIGHT) / max(panel.picture.height for panel in panels),
    )
    floor = top - scale * max(panel.picture.height for panel in panels)
    for panel in panels:
        _panel(canvas, panel, left, floor, scale)
        caption(canvas, panel.picture.caption, left, floor)
        left += scale * panel.picture.width + GAP


def _panel(canvas: Canvas, panel: TapePicture, left: float, floor: float, scale: float) -> None:
    picture = panel.picture
    canvas.saveState()
    # From here on in the picture's pixels, upward from its lower edge.
    canvas.translate(left, floor)
    canvas.scale(scale, scale)
    canvas.drawImage(
        ImageReader(io.BytesIO(picture.content)), 0, 0, width=picture.width, height=picture.height
    )
    canvas.setLineJoin(1)
    _lines(canvas, panel.others, picture.height, colour=OTHER, width=OTHER_PX)
    _lines(canvas, panel.lines, picture.height, colour=TAPE, width=TAPE_PX)
    for tag in panel.tags:
        _tag(canvas, tag, picture.height)
    canvas.restoreState()


def _lines(
    canvas: Canvas, lines: tuple[Points2D, ...], height: int, *, colour: Color, width: float
) -> None:
    canvas.setStrokeColor(colour)
    canvas.setLineWidth(width)
    path = canvas.beginPath()
    for line in lines:
        (x, y), *others = line.tolist()
        path.moveTo(x, height - y)
        for x, y in others:
            path.lineTo(x, height - y)
    canvas.drawPath(path)


def _tag(canvas: Canvas, tag: Tag, height: int) -> None:
    canvas.setFillColor(PAPER)
    canvas.setStrokeColor(TAPE)
    canvas.setLineWidth(OTHER_PX)
    canvas.circle(tag.x, height - tag.y, TAG_PX, stroke=1, fill=1)
    canvas.setFillColor(INK)
    canvas.setFont("Helvetica", NUMBER_PX)
    canvas.drawCentredString(tag.x, height - tag.y - BASELINE_PX, str(tag.number))
