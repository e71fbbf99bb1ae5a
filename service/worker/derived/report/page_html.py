"""The report as one HTML file: styles and pictures embedded, no scripts.

In print one A4 page, and another one with what else was measured.
"""

import base64
from html import escape
from typing import Final

from fitter.arrays import Points2D
from service.worker.derived.report.content import (
    MeasurementGroup,
    MeasurementRow,
    ReportContent,
    Section,
)
from service.worker.derived.report.pictures import Picture, ReportPictures, TapePicture
from service.worker.derived.report.tape_drawing import TAG_PX, Tag
from service.worker.derived.report.wording import PictureWords, TableWords

STYLE: Final = """
@page { size: A4; margin: 12mm 14mm; }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 24px; max-width: 860px; background: #fff; color: #1c1c1c;
  font: 13px/1.4 "IBM Plex Sans", "Helvetica Neue", Arial, sans-serif; }
header { border-bottom: 2px solid #1c1c1c; margin-bottom: 14px; padding-bottom: 6px; }
h1 { font-size: 22px; font-weight: 600; margin: 0; }
header p { color: #555; margin: 2px 0 0; }
h2 { font-size: 13px; font-weight: 600; margin: 0 0 4px; }
.figures { grid-template-columns: repeat(4, 1fr); margin-bottom: 14px; }
.figures b { font-size: 24px; font-weight: 600; letter-spacing: -0.02em; }
.figures dd + dd { color: #555; font-size: 12px; }
.pictures { display: grid; gap: 18px; grid-template-columns: 1fr 1fr; align-items: start; }
.pictures svg { display: block; width: 100%; height: auto; max-height: 420px; }
.chief { display: grid; gap: 0 24px; grid-template-columns: 1fr 1fr; margin-top: 12px;
  align-items: start; }
.notes { display: grid; gap: 12px 24px; grid-template-columns: 1fr 1fr; margin-top: 12px; }
figure { margin: 0; }
figure img { display: block; width: 100%; height: auto; max-height: 420px; object-fit: contain;
  object-position: left top; }
figcaption, footer { color: #555; font-size: 11px; }
.tapes { margin-top: 16px; }
.tapes p { color: #555; font-size: 11px; }
.tapes div { display: flex; gap: 10px; align-items: flex-end; margin-top: 4px; }
.tapes svg { display: block; width: 100%; height: auto; }
:is(.tapes, .pictures) path { fill: none; stroke: #a2441f; stroke-width: 4;
  stroke-linejoin: round; }
:is(.tapes, .pictures) path.other { stroke: #c9a48f; stroke-width: 2; }
:is(.tapes, .pictures) circle { fill: #fff; stroke: #a2441f; stroke-width: 2; }
:is(.tapes, .pictures) text { font-size: 25px; text-anchor: middle; fill: #1c1c1c; }
.further { columns: 2; column-gap: 24px; margin-top: 12px; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { border-bottom: 1px solid #ddd; padding: 2px 0 2px 8px; text-align: right; }
th[scope=row], th:first-child { padding-left: 0; text-align: left; font-weight: 400; }
.no, .no + th { padding-left: 0; text-align: left; }
.no { width: 26px; color: #a2441f; }
thead th { border-bottom: 1px solid #888; color: #555; font-weight: 400; font-size: 11px; }
td { white-space: nowrap; } td.interval, th:last-child { white-space: nowrap; color: #555; }
dl { display: grid; gap: 0 10px; grid-template-columns: max-content 1fr; margin: 0; }
dt { color: #555; max-width: 150px; }
dd { margin: 0; }
section { break-inside: avoid; }
section { margin-bottom: 8px; }
section p { margin: 0 0 3px; }
footer { border-top: 1px solid #ddd; margin-top: 12px; padding-top: 5px; }
@media (max-width: 640px) {
  .pictures, .chief, .notes { grid-template-columns: 1fr; } .further { columns: 1; }
  .figures { grid-template-columns: 1fr 1fr; gap: 8px; } }
@media print {
  body { font-size: 8.5pt; line-height: 1.3; max-width: none; padding: 0; }
  h1 { font-size: 15pt; } h2 { font-size: 9pt; }
  figcaption, footer, thead th { font-size: 7pt; }
  .pictures, .chief, .notes { gap: 0 5mm; grid-template-columns: 1fr 1fr; }
  .figures { grid-template-columns: repeat(4, 1fr); } .figures b { font-size: 18pt; }
  figure img, .pictures svg { max-height: 98mm; } th, td { padding: 0.35mm 0 0.35mm 2mm; }
  dt { max-width: 32mm; }
  .tapes, .further { break-before: page; } .tapes + .further { break-before: auto; }
  .tapes div { max-width: 168mm; }
}
"""


def report_html(content: ReportContent, pictures: ReportPictures) -> bytes:
    """Write the page; the same report gives the same bytes."""
    words = content.wording
    rows, middle = content.measurements, (len(content.measurements) + 1) // 2
    first, *others = [each for each in content.sections if not each.for_experts]
    experts = [each for each in content.sections if each.for_experts]
    second = _tapes_figure(pictures.tapes[0]) if pictures.tapes else _figure(pictures.sides[0])
    body = f"""<header><h1>{escape(content.title)}</h1><p>{escape(content.subtitle)}</p></header>
<main>
{_figures(content.figures)}
<div class="pictures">
{_figure(pictures.overlay)}
{second}
</div>
<div class="chief">
{_measurements(rows[:middle], words.table)}
{_measurements(rows[middle:], words.table) if rows[middle:] else ""}
</div>
<div class="notes">
{_section(first)}
<div>
{"".join(_section(each) for each in others)}
</div>
</div>
{_tapes(pictures.tapes, words.pictures)}
{_further(content.further, words.table)}
{"".join(_section(each) for each in experts)}
</main>
<footer>{escape(words.footnote)}</footer>"""
    page = f"""<!doctype html>
<html lang="{words.language}">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{escape(content.title)}</title>
<style>{STYLE}</style>
</head>
<body>
{body}
</body>
</html>
"""
    return page.encode()


def _figures(rows: tuple[MeasurementRow, ...]) -> str:
    """What most people ask for, large."""
    each = "".join(
        f"<div><dt>{escape(row.name)}</dt><dd><b>{escape(row.value)}</b> {escape(row.unit)}</dd>"
        f"<dd>{escape(row.interval)}</dd></div>"
        for row in rows
    )
    return f'<dl class="figures">{each}</dl>' if rows else ""


def _figure(picture: Picture) -> str:
    encoded = base64.b64encode(picture.content).decode()
    caption = escape(picture.caption)
    return (
        f'<figure><img src="data:{picture.media_type};base64,{encoded}" alt="{caption}" '
        f'width="{picture.width}" height="{picture.height}">'
        f"<figcaption>{caption}</figcaption></figure>"
    )


def _measurements(rows: tuple[MeasurementRow, ...], words: TableWords) -> str:
    if not rows:
        return f"<section><p>{escape(words.withheld)}</p></section>"
    return f"<section>{_table(rows, words)}</section>"


def _further(groups: tuple[MeasurementGroup, ...], words: TableWords) -> str:
    if not groups:
        return ""
    tables = "".join(
        f"<section><h2>{escape(group.heading)}</h2>{_table(group.rows, words)}</section>"
        for group in groups
    )
    return f'<div class="further">{tables}</div>'


def _table(rows: tuple[MeasurementRow, ...], words: TableWords) -> str:
    numbered = any(row.number is not None for row in rows)
    lines = "\n".join(
        f'<tr>{_number(row) if numbered else ""}<th scope="row">{escape(row.name)}</th>'
        f"<td>{escape(row.value)}</td><td>{escape(row.unit)}</td>"
        f'<td class="interval">{escape(row.interval)}</td></tr>'
        for row in rows
    )
    heads = (words.measurement, words.value, words.unit, words.interval)
    number = f'<th scope="col" class="no">{escape(words.number)}</th>' if numbered else ""
    head = number + "".join(f'<th scope="col">{escape(each)}</th>' for each in heads)
    return f"<table>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{lines}\n</tbody></table>"


def _number(row: MeasurementRow) -> str:
    return f'<td class="no">{"" if row.number is None else row.number}</td>'


def _section(section: Section) -> str:
    facts = "".join(
        f"<dt>{escape(label)}</dt><dd>{escape(text)}</dd>" for label, text in section.facts
    )
    remarks = "".join(f"<p>{escape(remark)}</p>" for remark in section.remarks)
    return (
        f"<section><h2>{escape(section.heading)}</h2>"
        + (f"<dl>{facts}</dl>" if facts else "")
        + f"{remarks}</section>\n"
    )


def _tapes(panels: tuple[TapePicture, ...], words: PictureWords) -> str:
    """The tapes as vector drawings: all sides in a row, in one scale; nothing if there are none."""
    if not panels:
        return ""
    figures = "".join(map(_tapes_figure, panels))
    return (
        f'<section class="tapes"><h2>{escape(words.tapes)}</h2>'
        f"<p>{escape(words.tapes_note)}</p><div>{figures}</div></section>"
    )


def _tapes_figure(panel: TapePicture) -> str:
    picture = panel.picture
    encoded = base64.b64encode(picture.content).decode()
    caption = escape(picture.caption)
    return (
        f'<figure style="flex: {picture.width} 1 0">'
        f'<svg viewBox="0 0 {picture.width} {picture.height}" role="img" aria-label="{caption}">'
        f'<image href="data:{picture.media_type};base64,{encoded}" width="{picture.width}" '
        f'height="{picture.height}"/>'
        f'<path class="other" d="{_path(panel.others)}"/><path d="{_path(panel.lines)}"/>'
        f"{''.join(map(_tag, panel.tags))}</svg><figcaption>{caption}</figcaption></figure>"
    )


def _path(lines: tuple[Points2D, ...]) -> str:
    """Each line begins anew; a tenth of a pixel is a tenth of a millimetre of the body."""
    return "".join("M" + " ".join(f"{x:.1f},{y:.1f}" for x, y in line.tolist()) for line in lines)


def _tag(tag: Tag) -> str:
    return (
        f'<circle cx="{tag.x:.1f}" cy="{tag.y:.1f}" r="{TAG_PX:.0f}"/>'
        f'<text x="{tag.x:.1f}" y="{tag.y:.1f}" dy="9">{tag.number}</text>'
    )
