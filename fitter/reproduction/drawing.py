"""All of the paper's figures and its table, from the pictures that they are drawn of."""

import html
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final

from fitter.applications.animation import motion_of_clip
from fitter.applications.motion import Motion, motion_of_cycle
from fitter.applications.motion_file import MotionFile
from fitter.applications.named_motions import stride_of
from fitter.applications.rig import rig_of
from fitter.fits.pipeline import fit
from fitter.fits.prepared_model import prepared_model
from fitter.reproduction.ambiguities import figure_4, figure_5, fit_by_paper
from fitter.reproduction.first_guess import figure_2, figure_3
from fitter.reproduction.looks import figure_6, figure_7, figure_9, figure_10
from fitter.reproduction.panels import Figure
from fitter.reproduction.subject import COLUMNS, PRINTED, Sizes, Subject, Table, figure_8, table_1
from fitter.request import FitRequest, Paper
from fitter.result import FitResult
from fitter.vocabulary.choices import Cues

BY_PAPER: Final = "by the paper's method"
BY_OURS: Final = "by this package's method"


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Pictures:
    """Pictures that the figures are drawn of.

    Attributes
    ----------
    portrait
        One person, of Figs. 2, 3, 5, 7 and 9.
    subject
        Of Figs. 4 and 8 and of Table 1.
    hiding
        Which of the subject's pictures is that of Fig. 4.
    painting
        Of Fig. 10; without one there is none.
    motion
        Motion capture of Fig. 9; None for the walk that ships with the package.
    """

    portrait: FitRequest
    subject: Subject
    hiding: int
    painting: FitRequest | None = None
    motion: MotionFile | None = None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Reproduction:
    """The figures in their order, and Table 1 by the paper's method and by this package's."""

    figures: tuple[Figure, ...]
    tables: tuple[Table, ...]


def reproduce(
    pictures: Pictures, on_drawn: Callable[[Figure], None] = lambda _: None
) -> Reproduction:
    """Draw everything; ``on_drawn`` receives each figure as soon as it is there.

    Raises
    ------
    InvalidInputError
        If a picture cannot be used.
    """
    figures: list[Figure] = []

    def drawn(figure: Figure | None) -> None:
        if figure is not None:
            figures.append(figure)
            on_drawn(figure)

    portrait, subject = pictures.portrait, pictures.subject
    plain = fit_by_paper(portrait, Paper())
    drawn(figure_2(portrait, plain))
    drawn(figure_3(plain))
    drawn(figure_4(subject.pictures[pictures.hiding].request))
    drawn(figure_5(portrait, plain))
    drawn(figure_6())
    shaded = _fit(portrait)
    drawn(figure_7(shaded))
    by_paper = [fit_by_paper(each.request, Paper(), Cues.SES) for each in subject.pictures]
    ours = [_fit(each.request) for each in subject.pictures]
    drawn(figure_8("figure_8", f"Figure 8: SE and SES, {BY_PAPER}", subject, by_paper))
    drawn(figure_8("figure_8_ours", f"Figure 8 once more, {BY_OURS}", subject, ours))
    motion = _motion(shaded, pictures.motion)
    drawn(figure_9(portrait, shaded, motion, recorded=pictures.motion is not None))
    if pictures.painting is not None:
        drawn(figure_10(pictures.painting, _fit(pictures.painting)))
    return Reproduction(
        figures=tuple(figures),
        tables=(table_1(BY_PAPER, subject, by_paper), table_1(BY_OURS, subject, ours)),
    )


def _fit(request: FitRequest) -> FitResult:
    """As every fit is done, with shading; what is doubtful is shown too."""
    return fit(
        replace(
            request,
            views=tuple(replace(view, cues=Cues.SES) for view in request.views),
            choices=replace(request.choices, force=True),
        )
    )


def _motion(result: FitResult, source: MotionFile | None) -> Motion:
    model = prepared_model(result.person.gender).operators.model
    rig = rig_of(model, result.person.body.shape)
    if source is None:
        return motion_of_cycle(stride_of(rig), rig)
    return motion_of_clip(source, rig).motion


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
