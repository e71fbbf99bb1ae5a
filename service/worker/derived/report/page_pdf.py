"""The report as A4 pages of PDF, drawn with the fonts that every PDF reader has.

One page, and another one with the tapes on the body and what else was measured.
"""

import io
from html import escape
from typing import Final

from reportlab.lib.colors import HexColor
from reportlab.lib.pagesizes import A4
from reportlab.lib.styles import ParagraphStyle
from reportlab.lib.units import mm
from reportlab.lib.utils import ImageReader
from reportlab.pdfgen.canvas import Canvas
from reportlab.platypus import Flowable, Frame, KeepInFrame, Paragraph, Spacer, Table

from service.worker.derived.report.content import (
    MeasurementGroup,
    MeasurementRow,
    ReportContent,
    Section,
)
from service.worker.derived.report.pictures import Picture, ReportPictures
from service.worker.derived.report.tapes_pdf import draw_tapes
from service.worker.derived.report.wording import TableWords, Wording

PAGE_WIDTH, PAGE_HEIGHT = A4
MARGIN: Final = 14 * mm
WIDTH: Final = PAGE_WIDTH - 2 * MARGIN
GUTTER: Final = 5 * mm

HEADER_BASELINE: Final = PAGE_HEIGHT - MARGIN - 5 * mm
TOP: Final = HEADER_BASELINE - 10 * mm
FIGURES_HEIGHT: Final = 19 * mm
PICTURES_HEIGHT: Final = 104 * mm
TABLE_HEIGHT: Final = 74 * mm
WITHHELD_HEIGHT: Final = 8 * mm
CAPTION_HEIGHT: Final = 4.5 * mm
FOOTER_HEIGHT: Final = 10 * mm
TAPES_HEADING: Final = 11 * mm
TAPES_HEIGHT: Final = 88 * mm

INK: Final = HexColor("#1c1c1c")
GREY: Final = HexColor("#555555")
RULE: Final = HexColor("#dddddd")

TEXT: Final = ParagraphStyle(
    "text", fontName="Helvetica", fontSize=8, leading=10, textColor=INK, spaceAfter=1
)
FIGURE_SIZE: Final = 19
NAME: Final = ParagraphStyle("name", parent=TEXT, leading=9.6, spaceAfter=0)
LABEL: Final = ParagraphStyle("label", parent=TEXT, textColor=GREY)
HEADING: Final = ParagraphStyle(
    "heading", parent=TEXT, fontName="Helvetica-Bold", fontSize=9, leading=12, spaceBefore=3
)
SMALL: Final = ParagraphStyle("small", parent=LABEL, fontSize=6.5, leading=8)

FONT_ENCODING: Final = "cp1252"
"""What the built-in fonts can show; anything else becomes a question mark."""


def report_pdf(content: ReportContent, pictures: ReportPictures) -> bytes:
    """Draw the page; the same report gives the same bytes."""
    stream = io.BytesIO()
    canvas = Canvas(stream, pagesize=A4, invariant=True, pageCompression=True)
    canvas.setTitle(content.title)
    canvas.setAuthor("Maquette")
    _header(canvas, content)

    top = TOP
    if content.figures:
        _figures(canvas, content.figures, top)
        top -= FIGURES_HEIGHT
    half = (WIDTH - GUTTER) / 2
    _picture(canvas, pictures.overlay, MARGIN, top, half, PICTURES_HEIGHT)
    _beside(canvas, pictures, MARGIN + half + GUTTER, top, half)
    top -= PICTURES_HEIGHT + 2 * mm
    top -= _chief(canvas, content, top)
    bottom = MARGIN + FOOTER_HEIGHT
    first, *others = [each for each in content.sections if not each.for_experts]
    for number, sections in enumerate(([first], others)):
        parts = [part for section in sections for part in _section(section, half)]
        _fill(canvas, parts, (MARGIN + number * (half + GUTTER), bottom, half, top - bottom))
    _footer(canvas, content.wording)
    canvas.showPage()
    if content.further or pictures.tapes:
        _second_page(canvas, content, pictures)
    canvas.save()
    return stream.getvalue()


def _figures(canvas: Canvas, rows: tuple[MeasurementRow, ...], top: float) -> None:
    """What most people ask for, large and in columns."""
    step = WIDTH / len(rows)
    for number, row in enumerate(rows):
        left = MARGIN + number * step
        canvas.setFillColor(GREY)
        canvas.setFont("Helvetica", 8)
        canvas.drawString(left, top - 3 * mm, _shown(row.name))
        canvas.drawString(left, top - 14 * mm, _shown(row.interval))
        canvas.setFillColor(INK)
        canvas.setFont("Helvetica-Bold", FIGURE_SIZE)
        canvas.drawString(left, top - 10 * mm, _shown(row.value))
        after = left + canvas.stringWidth(_shown(row.value), "Helvetica-Bold", FIGURE_SIZE)
        canvas.setFont("Helvetica", 9)
        canvas.drawString(after + 1 * mm, top - 10 * mm, _shown(row.unit))


def _beside(
    canvas: Canvas, pictures: ReportPictures, left: float, top: float, width: float
) -> None:
    """The second picture: the upright body with its tapes, or as it stands where there are none."""
    box = (left, top, width, PICTURES_HEIGHT)
    if pictures.tapes:
        draw_tapes(canvas, pictures.tapes[:1], box, caption=_caption)
    else:
        _picture(canvas, pictures.sides[0], *box)


def _chief(canvas: Canvas, content: ReportContent, top: float) -> float:
    """The chief measurements in two columns of one width; returns how much height they take."""
    rows, table = content.measurements, content.wording.table
    half = (WIDTH - GUTTER) / 2
    if not rows:
        box = (MARGIN, top - WITHHELD_HEIGHT, WIDTH, WITHHELD_HEIGHT)
        _fill(canvas, [Paragraph(_text(table.withheld), TEXT)], box)
        return WITHHELD_HEIGHT
    middle = (len(rows) + 1) // 2
    for number, part in enumerate((rows[:middle], rows[middle:])):
        if part:
            left = MARGIN + number * (half + GUTTER)
            box = (left, top - TABLE_HEIGHT, half, TABLE_HEIGHT)
            _fill(canvas, [_measurements(part, half, table, numbered=True)], box)
    return TABLE_HEIGHT


def _second_page(canvas: Canvas, content: ReportContent, pictures: ReportPictures) -> None:
    """Where the tapes lie, and below it what else was measured."""
    _header(canvas, content)
    top = TOP
    if pictures.tapes:
        words = content.wording.pictures
        heading: list[Flowable] = [
            Paragraph(_text(words.tapes), HEADING),
            Paragraph(_text(words.tapes_note), LABEL),
        ]
        _fill(canvas, heading, (MARGIN, top - TAPES_HEADING, WIDTH, TAPES_HEADING))
        drawn = (MARGIN, top - TAPES_HEADING, WIDTH, TAPES_HEIGHT)
        draw_tapes(canvas, pictures.tapes, drawn, caption=_caption)
        top -= TAPES_HEADING + TAPES_HEIGHT + GUTTER
    _further(canvas, content, top)
    _footer(canvas, content.wording)
    canvas.showPage()


def _further(canvas: Canvas, content: ReportContent, top: float) -> None:
    """What else was measured, in two columns: groups as they come, what is for experts last."""
    half = (WIDTH - GUTTER) / 2
    columns: tuple[list[MeasurementGroup], list[MeasurementGroup]] = ([], [])
    rows = sum(len(group.rows) for group in content.further)
    placed = 0
    for group in content.further:
        columns[0 if 2 * placed < rows else 1].append(group)
        placed += len(group.rows)
    bottom = MARGIN + FOOTER_HEIGHT
    for number, groups in enumerate(columns):
        flowables = [
            part
            for group in groups
            for part in (
                Paragraph(_text(group.heading), HEADING),
                _measurements(group.rows, half, content.wording.table, numbered=False),
            )
        ]
        if number == 1:
            flowables += [
                part
                for section in content.sections
                if section.for_experts
                for part in _section(section, half)
            ]
        left = MARGIN + number * (half + GUTTER)
        _fill(canvas, flowables, (left, bottom, half, top - bottom))


def _footer(canvas: Canvas, wording: Wording) -> None:
    footnote = Paragraph(_text(wording.footnote), SMALL)
    _fill(canvas, [footnote], (MARGIN, MARGIN, WIDTH, FOOTER_HEIGHT))


def _header(canvas: Canvas, content: ReportContent) -> None:
    canvas.setFillColor(INK)
    canvas.setFont("Helvetica-Bold", 15)
    canvas.drawString(MARGIN, HEADER_BASELINE, content.title)
    canvas.setFillColor(GREY)
    canvas.setFont("Helvetica", 9)
    canvas.drawString(MARGIN, HEADER_BASELINE - 5 * mm, _shown(content.subtitle))
    canvas.setStrokeColor(INK)
    canvas.setLineWidth(1)
    canvas.line(MARGIN, HEADER_BASELINE - 7 * mm, MARGIN + WIDTH, HEADER_BASELINE - 7 * mm)


def _picture(
    canvas: Canvas, picture: Picture, left: float, top: float, width: float, height: float
) -> None:
    """Draw a picture at the box's top left, as large as the box allows, with its caption below."""
    room = height - CAPTION_HEIGHT
    scale = min(width / picture.width, room / picture.height)
    drawn_width, drawn_height = scale * picture.width, scale * picture.height
    canvas.drawImage(
        ImageReader(io.BytesIO(picture.content)),
        left,
        top - drawn_height,
        width=drawn_width,
        height=drawn_height,
    )
    _caption(canvas, picture.caption, left, top - drawn_height)


def _caption(canvas: Canvas, caption: str, left: float, top: float) -> None:
    canvas.setFillColor(GREY)
    canvas.setFont("Helvetica", 7)
    canvas.drawString(left, top - 3.2 * mm, _shown(caption))


def _fill(
    canvas: Canvas, flowables: list[Flowable], box: tuple[float, float, float, float]
) -> None:
    """Fill a box (left, bottom, width, height) from the top; what is too long is shrunk to fit."""
    left, bottom, width, height = box
    frame = Frame(
        left,
        bottom,
        width,
        height,
        leftPadding=0,
        rightPadding=0,
        topPadding=0,
        bottomPadding=0,
    )
    frame.add(KeepInFrame(width, height, flowables, mode="shrink"), canvas)


def _measurements(
    rows: tuple[MeasurementRow, ...], width: float, words: TableWords, *, numbered: bool
) -> Flowable:
    numbers = ["" if row.number is None else str(row.number) for row in rows]
    cells: list[list[str | Flowable]] = [
        [words.measurement, words.value, words.unit, words.interval]
    ]
    # Names may need two lines.
    cells += [
        [Paragraph(_text(row.name), NAME), *map(_shown, (row.value, row.unit, row.interval))]
        for row in rows
    ]
    shares = [0.44, 0.14, 0.12, 0.30]
    if numbered:
        cells = [
            [number, *row] for number, row in zip([words.number, *numbers], cells, strict=True)
        ]
        shares = [0.06, 0.40, *shares[1:]]
    return Table(
        cells,
        colWidths=[share * width for share in shares],
        style=[
            ("FONT", (0, 0), (-1, -1), "Helvetica", 8),
            ("FONTSIZE", (0, 0), (-1, 0), 7),
            ("TEXTCOLOR", (0, 0), (-1, -1), INK),
            ("TEXTCOLOR", (0, 0), (-1, 0), GREY),
            ("TEXTCOLOR", (-1, 1), (-1, -1), GREY),
            ("VALIGN", (0, 0), (-1, -1), "MIDDLE"),
            ("ALIGN", (-3, 0), (-1, -1), "RIGHT"),
            ("LINEBELOW", (0, 0), (-1, -1), 0.4, RULE),
            ("LEFTPADDING", (0, 0), (-1, -1), 0),
            ("RIGHTPADDING", (0, 0), (-1, -1), 2),
            ("TOPPADDING", (0, 0), (-1, -1), 1.2),
            ("BOTTOMPADDING", (0, 0), (-1, -1), 1.8),
        ],
    )


def _section(section: Section, width: float) -> list[Flowable]:
    parts: list[Flowable] = [Paragraph(_text(section.heading), HEADING)]
    if section.facts:
        parts.append(
            Table(
                [
                    [Paragraph(_text(label), LABEL), Paragraph(_text(text), TEXT)]
                    for label, text in section.facts
                ],
                colWidths=[0.34 * width, 0.66 * width],
                style=[
                    ("VALIGN", (0, 0), (-1, -1), "TOP"),
                    ("LEFTPADDING", (0, 0), (-1, -1), 0),
                    ("RIGHTPADDING", (0, 0), (-1, -1), 3),
                    ("TOPPADDING", (0, 0), (-1, -1), 0),
                    ("BOTTOMPADDING", (0, 0), (-1, -1), 0.5),
                ],
            )
        )
    parts += [Paragraph(_text(remark), TEXT) for remark in section.remarks]
    parts.append(Spacer(width, 1.5 * mm))
    return parts


def _text(text: str) -> str:
    """Escape text for a paragraph, whose markup looks like HTML."""
    return escape(_shown(text))


def _shown(text: str) -> str:
    return text.encode(FONT_ENCODING, "replace").decode(FONT_ENCODING)
