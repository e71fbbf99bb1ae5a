"""A page to print: one HTML file with its pictures in it, and no scripts."""

import base64
from collections.abc import Iterator, Sequence
from html import escape
from typing import Final

import cv2
import numpy as np
from jaxtyping import UInt8

from api_schemas.products.documents import PrintOptions, PrintResult
from api_schemas.results import FitResult, Measurement
from fitter.export.views import MARGIN_SHARE
from fitter.vocabulary.measurements import CHIEF
from service.compute.products.finished_fit import FinishedFit, Made, Report
from service.jobs.inputs import BODY, OVERLAY, RESULT, of_view

PICTURE_HEIGHT_PX: Final = 900
JPEG_QUALITY: Final = 85
LOWEST_MM, TALLEST_MM = 45, 80
"""Heights of the pictures in a row."""

_STYLE: Final = """
@page { size: A4; margin: 14mm; }
body { margin: 0 auto; max-width: 860px; padding: 20px; background: #fff; color: #1c1c1c;
  font: 12px/1.4 "IBM Plex Sans", "Helvetica Neue", Arial, sans-serif; }
@media print { body { padding: 0; } }
h1 { font-size: 22px; margin: 0; }
h2 { font-size: 14px; margin: 18px 0 4px; break-after: avoid; }
p { margin: 2px 0 10px; }
.pictures { display: flex; flex-wrap: wrap; gap: 14px; margin: 12px 0; }
figure { margin: 0; }
img { display: block; width: 100%; }
figcaption, .taken, footer { color: #555; font-size: 10.5px; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
table { margin-bottom: 4px; }
td, th { border-bottom: 1px solid #ddd; padding: 3px 12px 3px 0; text-align: left;
  vertical-align: baseline; font-weight: normal; }
thead th { border-bottom-color: #888; color: #555; font-size: 10.5px; }
tbody th { white-space: nowrap; width: 130px; }
tbody th::first-letter { text-transform: uppercase; }
td.value { font-weight: bold; }
.number { text-align: right; white-space: nowrap; width: 84px; }
tr, figure, li { break-inside: avoid; }
ul { margin: 0; padding-left: 16px; }
footer { margin-top: 14px; }
"""

_Picture = UInt8[np.ndarray, "h w 3"]

_EXPLAINED: Final = (
    "95 % of true values lie in the range. A value that was given is held and has none."
)


def make(fit: FinishedFit, options: PrintOptions, report: Report) -> Made[PrintResult]:
    """Write the page."""
    del options
    result = FitResult.model_validate_json(fit.files[RESULT])
    report(0.2)
    figures = [
        _figure(_decoded(fit.files[name]), caption)
        for name, caption in _captions(result)
        if name in fit.files
    ]
    if BODY in fit.files:
        body = _unlabelled(_decoded(fit.files[BODY]))
        figures.append(_figure(body, "The body: front, side, back"))
    return Made(result=PrintResult(), files={"print.html": _page(result, figures).encode()})


def _captions(result: FitResult) -> Iterator[tuple[str, str]]:
    for number, view in enumerate(result.views):
        seen = "" if view.view is None else f", {view.view}"
        yield of_view(number, OVERLAY), f"Picture {number + 1}{seen}"


def _decoded(picture: bytes) -> _Picture:
    pixels = cv2.imdecode(np.frombuffer(picture, dtype=np.uint8), cv2.IMREAD_COLOR)
    assert pixels is not None
    return np.asarray(pixels, dtype=np.uint8)


def _unlabelled(body: _Picture) -> _Picture:
    """The body's picture without its margin, where words would be too small to read."""
    margin = round(MARGIN_SHARE * len(body))
    return body[margin:-margin]


def _jpeg(pixels: _Picture) -> bytes:
    """The picture as tall as a page shows it at most."""
    height, width = pixels.shape[:2]
    if height > PICTURE_HEIGHT_PX:
        size = (max(round(width * PICTURE_HEIGHT_PX / height), 1), PICTURE_HEIGHT_PX)
        pixels = cv2.resize(pixels, size, interpolation=cv2.INTER_AREA)
    _, encoded = cv2.imencode(".jpg", pixels, [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])
    return encoded.tobytes()


def _page(result: FitResult, figures: Sequence[str]) -> str:
    count = len(result.views)
    found = f"{result.gender.value}, {100.0 * result.height_m:.1f} cm tall, from " + (
        "one picture" if count == 1 else f"{count} pictures"
    )
    return f"""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Body measurements</title>
<style>{_STYLE}</style>
</head>
<body>
<h1>Body measurements</h1>
<p>{escape(found)}</p>
<div class="pictures">{"".join(figures)}</div>
{_chief_measurements(result)}
{_remarks(result)}
{_other_measurements(result)}
<footer>Measured by Maquette after Guan et al., Estimating human shape and pose from a single image
(ICCV 2009).</footer>
</body>
</html>
"""


def _figure(picture: _Picture, caption: str) -> str:
    """A figure; all of a row are equally tall."""
    height, width = picture.shape[:2]
    encoded = base64.b64encode(_jpeg(picture)).decode()
    share = width / height
    widths = f"flex: {share:.3f}; min-width: {LOWEST_MM * share:.0f}mm"
    return (
        f'<figure style="{widths}; max-width: {TALLEST_MM * share:.0f}mm">'
        f'<img alt="{escape(caption)}" src="data:image/jpeg;base64,{encoded}">'
        f"<figcaption>{escape(caption)}</figcaption></figure>"
    )


def _chief_measurements(result: FitResult) -> str:
    """A table of those most asked for; why there is none where they are withheld."""
    if not result.measurements:
        return f"<p><b>The measurements are withheld.</b> {escape(result.outcome_explanation)}</p>"
    by_name = {each.name: each for each in result.measurements}
    chief = [by_name[name] for name in CHIEF if name in by_name]
    return _table("Measurements", chief) + f"<p>{_EXPLAINED}</p>"


def _other_measurements(result: FitResult) -> str:
    others = [each for each in result.measurements if each.name not in CHIEF]
    return _table("Further measurements", others) if others else ""


def _table(title: str, measurements: Sequence[Measurement]) -> str:
    rows = "".join(map(_row, measurements))
    return (
        f"<h2>{escape(title)}</h2><table><thead><tr><th></th><th class='number'>Value</th>"
        "<th class='number'>95 % range</th><th>How it is taken</th></tr></thead>"
        f"<tbody>{rows}</tbody></table>"
    )


def _row(each: Measurement) -> str:
    is_exact = each.low is None or each.high is None or each.low == each.high
    interval = "given" if is_exact and each.given else ""
    if not is_exact:
        interval = f"{each.low:.1f} to {each.high:.1f}"
    return (
        f"<tr><th>{escape(each.name.replace('_', ' '))}</th>"
        f"<td class='number value'>{each.value:.1f} {escape(each.unit)}</td>"
        f"<td class='number'>{interval}</td><td class='taken'>{escape(each.definition)}</td></tr>"
    )


def _remarks(result: FitResult) -> str:
    """Assumptions, findings and warnings, of the fit and of each picture."""
    said = [each.text for each in (*result.assumptions, *result.warnings)]
    for number, view in enumerate(result.views, start=1):
        where = f"Picture {number}: " if len(result.views) > 1 else ""
        of_view = (*view.findings, *view.assumptions, *view.warnings)
        said += [f"{where}{each.text}" for each in of_view]
    items = "".join(f"<li>{escape(each)}</li>" for each in dict.fromkeys(said))
    return f"<h2>Remarks</h2><ul>{items}</ul>" if items else ""
