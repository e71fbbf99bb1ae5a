"""When the evidence contradicts that a person was measured, and what it says.

The bounds were chosen on the tuning halves of people and of nonsense (DECISIONS.md, "Nonsense is
called nonsense"). No person may come near them, in the dark, in grain, behind a table or with
careless clicks: a circle that is measured is laughed about, a person who is refused has no remedy.
"""

from dataclasses import dataclass
from typing import Final

from fitter.capture.finding import Code, Finding
from fitter.fits.plausibility import Plausibility
from fitter.fits.reporting import POOR_OVERLAP
from fitter.vocabulary.outcomes import Severity, Verdict

BAD_OVERLAP: Final = 0.78
ELSEWHERE_OVERLAP: Final = 0.3
"""With less the body and the mask are in different places; a table hides half a person."""

USUAL_BOUNDARY, LITTLE_BOUNDARY = 0.46, 0.22
"""Midway between nonsense and people on the tuning halves: 0.36 and 0.56 below a bad overlap, 0.09
and 0.35 below a poor one."""

MOST_BEYOND: Final = 0.2
"""Hair and skirts are at most 0.01 of the body; a second person in a mask is 0.8 and more."""

MOST_CLICK_DEVIATIONS: Final = 4.0
"""Points that are off by 3 % of the picture's height reach 3.3, points under wrong names 4.6."""

POOR_CLICK_DEVIATIONS: Final = 1.8
SOME_STRAIN, MUCH_STRAIN = 14.0, 25.0
"""Nats, under the priors of pose and shape. A body stretched over an animal's shape costs 17 and
more, that of a person seen as badly at most 11. An animal's joints are 2.2 standard deviations off
a body of 34 nats; an athlete's body costs 26, with points that are off by 1.0."""


_REMEDIES: Final = {
    Verdict.IMPLAUSIBLE: (
        "See whether the points are on the right joints of one person, and whether a mask that was "
        "sent shows this person alone."
    ),
    Verdict.NO_PERSON: "Click the joints of a person, or send another picture.",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Contradiction:
    """The verdict on a fit, and what contradicts a person: nothing, or one finding that blocks."""

    verdict: Verdict = Verdict.PLAUSIBLE
    findings: tuple[Finding, ...] = ()


def contradiction(found: Plausibility) -> Contradiction:
    """Judge a fit by how it agrees with the evidence."""
    is_empty = found.boundary < _least_boundary(found)
    is_no_body = (
        found.overlap < POOR_OVERLAP
        and found.click_deviations > POOR_CLICK_DEVIATIONS
        and found.strain > MUCH_STRAIN
    )
    is_elsewhere = found.overlap < ELSEWHERE_OVERLAP
    is_more = found.beyond > MOST_BEYOND
    is_muddled = found.click_deviations > MOST_CLICK_DEVIATIONS
    if not (is_empty or is_no_body or is_elsewhere or is_more or is_muddled):
        return Contradiction()
    nobody = found.detected is False or (is_empty and not found.detected)
    said = {
        "The detector finds no person where the points are.": found.detected is False,
        f"The picture changes clearly along {found.boundary:.0%} of the body's outline; along a "
        "person's it does along more than half.": is_empty,
        f"The body and what was taken for the person overlap by {found.overlap:.0%}; with people "
        "it is about nine tenths.": is_empty or is_no_body or is_elsewhere,
        "What was taken for the person has parts that are not the body's, "
        f"{found.beyond:.0%} of its size: somebody or something else.": is_more,
        f"The points lie {found.click_deviations:.1f} standard deviations off the body's own; a "
        "person's lie within about one.": is_no_body or is_muddled,
        "The points ask for a pose or a shape that people hardly have.": is_no_body,
    }
    verdict = Verdict.NO_PERSON if nobody else Verdict.IMPLAUSIBLE
    finding = Finding(
        code=Code.CONTRADICTED,
        severity=Severity.BLOCKS,
        reason=" ".join(sentence for sentence, holds in said.items() if holds),
        remedy=_REMEDIES[verdict],
    )
    return Contradiction(verdict=verdict, findings=(finding,))


def _least_boundary(found: Plausibility) -> float:
    """Share of the outline that must be seen, if the silhouette is no person's either.

    People hardly told from the wall have a good silhouette, people half hidden a clear outline. In
    loose clothes every silhouette is good.
    """
    if found.overlap >= POOR_OVERLAP:
        if found.detected or not found.clothed:
            return 0.0
        return LITTLE_BOUNDARY if found.detected is None else USUAL_BOUNDARY
    is_bad = found.overlap < BAD_OVERLAP
    if found.detected:
        return LITTLE_BOUNDARY if is_bad else 0.0
    if found.detected is False or is_bad or found.strain > SOME_STRAIN:
        return USUAL_BOUNDARY
    return LITTLE_BOUNDARY
