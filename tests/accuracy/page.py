"""An HTML page of all fits, after the paper's Fig. 8."""

import html
from collections.abc import Sequence
from pathlib import Path

from fitter.vocabulary.choices import Cues
from tests.accuracy.scoring import Scored
from tests.accuracy.sheets import FULL_SCALE_MM, PANELS, panel_name
from tests.accuracy.table import case_lines, summary_lines

_HEAD = """<!doctype html>
<html lang="en">
<meta charset="utf-8">
<title>Evaluation</title>
<style>
body { font: 14px sans-serif; margin: 1.5em; }
.row { display: flex; gap: 6px; overflow-x: auto; }
figure { margin: 0; flex: none; }
figure img { height: 420px; display: block; }
figcaption { color: #555; }
pre { font-size: 12px; overflow-x: auto; }
</style>
"""

_LEGEND = (
    "<p>Outlines: blue the true body, green the fit. Errors: distances of vertices in the "
    f"canonical pose, black 0 to white {FULL_SCALE_MM:.0f} mm.</p>"
)


def write_page(folder: Path, scored: Sequence[Scored]) -> Path:
    """``index.html`` beside the pictures of :func:`tests.accuracy.sheets.write_pictures`."""
    names = list(dict.fromkeys(each.name for each in scored))
    parts = [
        _HEAD,
        "<h1>Evaluation</h1>",
        _LEGEND,
        _preformatted(summary_lines(scored)),
    ]
    for name in names:
        fits = [each for cues in Cues for each in scored if (each.name, each.cues) == (name, cues)]
        figures = "".join(
            f'<figure><img src="{panel_name(name, number)}" alt="{title}" loading="lazy">'
            f"<figcaption>{title}</figcaption></figure>"
            for number, title in enumerate(PANELS)
            if (folder / panel_name(name, number)).exists()
        )
        heading = f'<h2 id="{name}">{name} <small>({fits[0].half.value})</small></h2>'
        parts += [heading, f'<div class="row">{figures}</div>', _preformatted(case_lines(fits))]
    path = folder / "index.html"
    path.write_text("\n".join([*parts, "</html>", ""]))
    return path


def _preformatted(lines: Sequence[str]) -> str:
    return f"<pre>{html.escape(chr(10).join(lines))}</pre>"
