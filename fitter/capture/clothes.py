"""Whether loose clothes hide the body, as the fit sees them too, and what may be said of them."""

from collections.abc import Sequence
from typing import Final

from fitter.capture.capture import Capture
from fitter.vocabulary.choices import BodyRegion, Clothing, Covering
from fitter.vocabulary.outcomes import ClothingGuess, WornRegion
from fitter.vocabulary.remarks import Code, Remark, Severity, remark, unchecked

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

_PROBABLY: Final = 0.5


def clothes(capture: Capture) -> Remark | None:
    """Whether clothes stand off the trunk or the legs, or whether that cannot be seen."""
    if capture.directions is None and (capture.mask is None or capture.stature_px is None):
        return unchecked(
            Code.CLOTHES_LOOSE,
            "There is no outline, for want of a detector, or too few joints are seen.",
        )
    if capture.clothing is None:
        return remark(
            Code.SKIN_NOT_FOUND,
            "Neither face nor hands show the colour of the person's skin, or the picture has "
            "no colours: clothes are taken to be loose.",
            severity=Severity.HARMS,
            where=("nose",),
        )
    loose = _loose(capture.clothing)
    if not loose:
        return None
    said = [f"{_WORDS[region]} ({100.0 * share:.0f} %)" for region, share in loose.items()]
    return remark(
        Code.CLOTHES_LOOSE,
        f"Loose clothes seem to cover {listed(said)}: the body under them is estimated.",
        severity=Severity.HARMS,
        where=tuple(
            f"{side}_{joint}"
            for region in loose
            for joint in _JOINTS[region]
            for side in ("left", "right")
        ),
    )


def clothing_guess(capture: Capture) -> ClothingGuess | None:
    """Clothes as they look; None where no outline is cut out, or nobody is found."""
    if capture.mask is None or capture.stature_px is None:
        return None
    bare = {each.region for each in capture.clothing or () if each.kind is Covering.BARE}
    over_top = capture.over_top or 0.0
    if BodyRegion.UPPER not in bare and over_top > _PROBABLY:
        return ClothingGuess(
            kind=Clothing.OUTER,
            reason="The network of what is worn sees a jacket, coat, vest or open shirt over a top,"
            f" with a probability of {100.0 * over_top:.0f} %.",
        )
    if (doubt := clothes(capture)) is not None:
        return ClothingGuess(kind=Clothing.LOOSE, reason=doubt.reason)
    return ClothingGuess(
        kind=Clothing.TIGHT,
        reason="Trunk and legs show the skin's colour, or are as narrow as in close clothes.",
    )


def _loose(clothing: Sequence[WornRegion]) -> dict[BodyRegion, float]:
    """Regions in loose clothes, with the probability that they are."""
    return {
        each.region: each.probability
        for each in clothing
        if each.region in _WORDS and each.kind is Covering.LOOSE
    }


def listed(words: Sequence[str]) -> str:
    """Words as a sentence has them: with commas, and an "and" before the last."""
    *others, last = words
    return f"{', '.join(others)} and {last}" if others else last
