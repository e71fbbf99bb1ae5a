"""How many people and how much nonsense each verdict is given to, with a detector and without."""

from collections.abc import Sequence
from dataclasses import dataclass

from fitter.errors import InvalidInputError
from fitter.fits.pipeline import fit
from fitter.request import FitRequest
from fitter.vocabulary.choices import Cues
from fitter.vocabulary.outcomes import Verdict
from tests.evaluation.detector_figures import Hints, hinted
from tests.evaluation.nonsense import Nonsense
from tests.evaluation.runs import picture_of
from tests.one_picture import changed

ASKED = (Hints.NONE, Hints.ALL)


@dataclass(frozen=True, slots=True, kw_only=True)
class Judged:
    """The verdict on one request."""

    kind: str
    name: str
    hints: Hints
    verdict: Verdict


def judged_picture(name: str) -> list[Judged]:
    """A picture of the suite's own or a foreign one, by the name of its set."""
    picture = picture_of(name)
    return _judged(picture.series.value, name, changed(picture.request, cues=Cues.SES))


def judged_nonsense(made: Nonsense) -> list[Judged]:
    """A request without an answer."""
    return _judged(made.kind, made.name, made.request)


def verdict_lines(judged: Sequence[Judged]) -> list[str]:
    """One line a kind: of how many a person is contradicted, without and with the detector."""
    lines = [f"{'kind':24s}{'requests':>9s}{'without':>9s}{'with':>6s}"]
    for kind in dict.fromkeys(each.kind for each in judged):
        of_kind = [each for each in judged if each.kind == kind]
        counts = [
            sum(each.verdict is not Verdict.PLAUSIBLE for each in of_kind if each.hints is hints)
            for hints in ASKED
        ]
        lines.append(f"{kind:24s}{len(of_kind) // len(ASKED):9d}{counts[0]:9d}{counts[1]:6d}")
    return lines


def _judged(kind: str, name: str, request: FitRequest) -> list[Judged]:
    return [
        Judged(
            kind=kind,
            name=name,
            hints=hints,
            verdict=_verdict(hinted(changed(request, force=True), hints)),
        )
        for hints in ASKED
    ]


def _verdict(request: FitRequest) -> Verdict:
    """The fit's, or that of the refusal of points that nobody in front of a camera has."""
    try:
        return fit(request).found.verdict
    except InvalidInputError as error:
        if error.code != "person-not-found":
            raise
        return Verdict.NO_PERSON
