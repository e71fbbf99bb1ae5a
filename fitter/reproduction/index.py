"""The page that shows the figures with their captions, and Table 1 beside the paper's."""

import html
from collections.abc import Sequence
from typing import Final

from fitter.reproduction.drawing import Reproduction
from fitter.reproduction.subject import COLUMNS, PRINTED, Sizes, Table

_STYLE: Final = (
    "body{font:16px/1.5 sans-serif;max-width:75rem;margin:2rem auto;padding:0 1rem}"
    "img{max-width:100%}table{border-collapse:collapse;margin:1rem 0}"
    "td,th{padding:.2rem .7rem;text-align:right;border-bottom:1px solid #ccc}"
    "caption{text-align:left;font-weight:bold}"
)
_INTRODUCTION: Final = (
    "The figures and the table of P. Guan, A. Weiss, A. O. Bălan and M. J. Black, Estimating Human "
    "Shape and Pose from a Single Image, ICCV 2009, drawn from fits of this package. Pictures are "
    "rendered people, unless others were given. Fig. 1 is an overview of the others."
)
TABLE_NOTE: Final = (
    "In parentheses the deviation from the truth. The waist is the navel's. The paper's truth "
    "differs from pose to pose, since it is a fit to each; here it is one body at rest."
)
PRINTED_TABLE: Final = Table(title="as the paper prints it", rows=PRINTED)


def index_html(reproduction: Reproduction) -> str:
    """A page for a folder in which the figures lie as ``NAME.png``."""
    parts = [f"<h1>The paper, reproduced</h1><p>{html.escape(_INTRODUCTION)}</p>"]
    for each in reproduction.figures:
        title = html.escape(each.title)
        parts.append(
            f'<h2>{title}</h2><img src="{each.name}.png" alt="{title}">'
            f"<p>{html.escape(each.caption)}</p>"
            f"<p><em>Different:</em> {html.escape(each.differs)}</p>"
        )
    parts.append(f"<h2>Table 1</h2><p>{html.escape(TABLE_NOTE)}</p>")
    parts += [table_html(each) for each in (*reproduction.tables, PRINTED_TABLE)]
    return (
        '<!doctype html><html lang="en"><meta charset="utf-8"><title>The paper, reproduced</title>'
        f"<style>{_STYLE}</style><body>{''.join(parts)}</body></html>\n"
    )


def table_csv(tables: Sequence[Table]) -> str:
    """Table 1 of each kind, one line a pose."""
    heads = [f"{title} {kind}" for title, _ in COLUMNS for kind in ("SE", "SES", "GT")]
    lines = [",".join(["table", "pose", *heads])]
    for table in tables:
        for number, row in enumerate(table.rows, start=1):
            values = [f"{value:.1f}" for sizes in row for value in sizes]
            lines.append(",".join([table.title, str(number), *values]))
    return "\n".join(lines) + "\n"


def table_cells(row: Sizes) -> list[str]:
    """A pose's cells, with deviations from the truth."""
    return [
        cell
        for se, ses, true in row
        for cell in (_with_deviation(se, true), _with_deviation(ses, true), f"{true:.1f}")
    ]


def _with_deviation(value: float, true: float) -> str:
    # Adding zero leaves no "-0.0".
    return f"{value:.1f} ({round(value - true, 1) + 0.0:+.1f})"


def table_html(table: Table) -> str:
    """Table 1 by one method, as HTML."""
    top = "".join(f'<th colspan="3">{html.escape(title)}</th>' for title, _ in COLUMNS)
    kinds = "<th>SE</th><th>SES</th><th>GT</th>" * len(COLUMNS)
    rows = "".join(
        f"<tr><th>Pose {number}</th>"
        + "".join(f"<td>{cell}</td>" for cell in table_cells(row))
        + "</tr>"
        for number, row in enumerate(table.rows, start=1)
    )
    return (
        f"<table><caption>Table 1 {html.escape(table.title)}</caption>"
        f"<tr><th></th>{top}</tr><tr><th></th>{kinds}</tr>{rows}</table>"
    )
