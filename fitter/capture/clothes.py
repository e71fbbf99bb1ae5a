"""Whether loose clothes hide the body, as the fit sees them too."""

from typing import Final

from fitter.capture.capture import Capture
from fitter.capture.finding import Code, Finding, Remark, Unchecked
from fitter.vocabulary.choices import BodyRegion, Covering
from fitter.vocabulary.outcomes import Severity

_WORDS: Final = {
    BodyRegion.UPPER: "the upper body",
    BodyRegion.LOWER: "the thighs",
    BodyRegion.LEGS: "the lower legs",
}
"""Regions whose girths are measured; sleeves and shoes hide little."""

_JOINTS: Final = {
    BodyRegion.UPPER: ("shoulder",),
    BodyRegion.LOWER: ("hip", "knee"),
    BodyRegion.LEGS: ("knee", "ankle"),
}


def clothes(capture: Capture) -> Remark | None:
    """Whether clothes stand off the trunk or the legs."""
    if capture.mask is None:
        return Unchecked(code=Code.CLOTHES_LOOSE, reason="Without a detector there is no outline.")
    if capture.clothing is None:
        return Unchecked(
            code=Code.CLOTHES_LOOSE,
            reason="Neither face nor hands show the colour of the person's skin.",
        )
    loose = {
        each.region: each.probability
        for each in capture.clothing
        if each.region in _WORDS and each.kind is Covering.LOOSE
    }
    if not loose:
        return None
    regions = listed([_WORDS[region] for region in loose])
    return Finding(
        code=Code.CLOTHES_LOOSE,
        severity=Severity.HARMS,
        reason=(
            f"Loose clothes cover {regions}, with a probability of "
            f"{100.0 * min(loose.values()):.0f} %: the body under them is estimated."
        ),
        remedy="Have close-fitting clothes worn, or send the weight with the fit.",
        points=tuple(
            f"{side}_{joint}"
            for region in loose
            for joint in _JOINTS[region]
            for side in ("left", "right")
        ),
    )


def listed(words: list[str]) -> str:
    """Words with commas, and an "and" before the last."""
    *others, last = words
    return f"{', '.join(others)} and {last}" if others else last
