"""All of the paper's figures and its table, from the pictures that they are drawn of."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final

from fitter.applications.animation import motion_of_clip
from fitter.applications.cycle import motion_of_cycle
from fitter.applications.motion import Motion
from fitter.applications.motion_file import MotionFile
from fitter.applications.rig import rig_of
from fitter.applications.walk import stride_of
from fitter.fits.pipeline import fit
from fitter.fits.prepared_model import prepared_model
from fitter.reproduction.ambiguities import figure_4, figure_5, fit_by_paper
from fitter.reproduction.first_guess import figure_2, figure_3
from fitter.reproduction.looks import figure_6, figure_7, figure_9, figure_10
from fitter.reproduction.panels import Figure
from fitter.reproduction.subject import Subject, Table, figure_8, table_1
from fitter.request import FitRequest, Paper
from fitter.result import FitResult
from fitter.vocabulary.choices import Cues

BY_PAPER: Final = "by the paper's method"
BY_OURS: Final = "by this package's method"


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Pictures:
    """What the figures are drawn of.

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
