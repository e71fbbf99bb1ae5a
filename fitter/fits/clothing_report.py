"""Report of clothes: how each region is covered, how the outline was taken, the doubts."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from fitter.arrays import GreyImage, Mask
from fitter.capture.clothes import what_is_loose
from fitter.energies.objective import Objective
from fitter.measurement.definitions import INTERVAL_SD
from fitter.optimizer.uncertainty import Certainty, covered_distances
from fitter.segmentation.coverage import Coverage
from fitter.segmentation.skin_colour import LEAST_SAMPLES, PersonRegions, SkinMap
from fitter.vocabulary.choices import BodyRegion, ClothedRegion, Clothing, Covering
from fitter.vocabulary.measurements import CENTIMETRES_PER_METRE
from fitter.vocabulary.outcomes import WornRegion
from fitter.vocabulary.remarks import Code, Note, Remark, remark

PARTS_OF: Final[Mapping[BodyRegion, frozenset[str]]] = {
    BodyRegion.UPPER: frozenset({"chest", "spine"}),
    BodyRegion.ARMS: frozenset({"arm", "forearm"}),
    BodyRegion.LOWER: frozenset({"pelvis", "thigh"}),
    BodyRegion.LEGS: frozenset({"shin"}),
    BodyRegion.FEET: frozenset({"foot"}),
}
"""Parts of the body model by region, by the last word of their names."""

_UNDER_TOP: Final = frozenset({BodyRegion.UPPER, BodyRegion.ARMS})
_MOST_OF: Final = 0.5
_EASES: Final[Mapping[BodyRegion, ClothedRegion]] = {
    BodyRegion.UPPER: ClothedRegion.UPPER,
    BodyRegion.LOWER: ClothedRegion.LOWER,
}


def worn_regions(
    regions: PersonRegions,
    skin: SkinMap,
    covered: Coverage,
    *,
    bare: GreyImage | None,
    loose: GreyImage | None,
) -> tuple[WornRegion, ...]:
    """Most probable covering of each region in sight.

    ``bare`` and ``loose`` (h, w) are the probabilities that a pixel's part is bare, and that what
    covers it is loose; None of people in underwear, of whom the regions as a whole are told.
    """
    found = _head(regions, skin)
    for region, kinds in PARTS_OF.items():
        seen = _seen(regions, kinds)
        if np.count_nonzero(seen) < LEAST_SAMPLES:
            continue
        if bare is None or loose is None:
            is_bare = 1.0 - (covered.top if region in _UNDER_TOP else covered.bottom)
            is_loose = 0.0
        else:
            is_bare = float(bare[seen].mean())
            # Whether shoes are loose, legs do not tell.
            may_be_loose = region is not BodyRegion.FEET
            is_loose = may_be_loose * float(((1.0 - bare[seen]) * loose[seen]).mean())
        shares = {
            Covering.BARE: is_bare,
            Covering.CLOSE: max(1.0 - is_bare - is_loose, 0.0),
            Covering.LOOSE: is_loose,
        }
        kind = max(shares, key=shares.__getitem__)
        found.append(_worn(region, kind, shares[kind]))
    return tuple(found)


def _seen(regions: PersonRegions, kinds: frozenset[str]) -> Mask:
    """(h, w) where parts are seen, by the last words of their names."""
    numbers = [
        number for number, name in enumerate(regions.part_names) if name.rpartition("_")[2] in kinds
    ]
    return regions.person & np.isin(regions.parts, numbers)


def _head(regions: PersonRegions, skin: SkinMap) -> list[WornRegion]:
    """Whether skin, or hair or a hat covers most of the head that is seen."""
    seen = _seen(regions, frozenset({"head"}))
    if not skin.learnt_from or np.count_nonzero(seen) < LEAST_SAMPLES:
        return []
    shown = float(skin.coloured[seen].mean())
    kind = Covering.BARE if shown >= _MOST_OF else Covering.LOOSE
    return [_worn(BodyRegion.HEAD, kind, max(shown, 1.0 - shown))]


def _worn(region: BodyRegion, kind: Covering, probability: float) -> WornRegion:
    return WornRegion(
        region=region,
        kind=kind,
        probability=probability,
        ease_cm=None,
        ease_standard_error_cm=None,
    )


def with_ease(
    worn: Sequence[WornRegion], objective: Objective, certain: Certainty
) -> tuple[WornRegion, ...]:
    """The same with how far loose clothes stand off the body that was found.

    Probabilities to a hundredth, eases to a millimetre.
    """
    distances = covered_distances(objective, certain)
    found: list[WornRegion] = []
    for each in worn:
        told = distances.get(_EASES[each.region]) if each.region in _EASES else None
        ease_cm, error_cm = None, None
        if each.kind is Covering.LOOSE and told is not None:
            ease_cm, error_cm = (round(CENTIMETRES_PER_METRE * metres, 1) for metres in told)
        found.append(
            replace(
                each,
                probability=round(each.probability, 2),
                ease_cm=ease_cm,
                ease_standard_error_cm=error_cm,
            )
        )
    return tuple(found)


def clothes_are_guessed(objective: Objective, said: frozenset[Clothing]) -> bool:
    """Whether neither the caller nor the colour of the person's skin tells what is covered."""
    clothes = objective.evidence.clothes
    return clothes is not None and not clothes.learnt_from and Clothing.AUTO in said


def clothing_warnings(objective: Objective, said: frozenset[Clothing]) -> tuple[Remark, ...]:
    """Doubts about how clothes were taken; empty for tight ones."""
    clothes = objective.evidence.clothes
    undressed = clothes is not None and clothes.looks_undressed
    return (_NOT_LOOSE,) if Clothing.LOOSE in said and undressed else ()


def with_what_clothes_cost(
    findings: Sequence[Remark],
    clothing: Sequence[WornRegion],
    waist_cm: float | None,
    weighed_cm: float | None,
) -> tuple[Remark, ...]:
    """The findings; that of loose clothes with how well the waist is known, and would be.

    Parameters
    ----------
    clothing
        How each region is covered.
    waist_cm
        Standard error of the smallest waist; None where nothing is measured.
    weighed_cm
        The same if the weight were known; None if it is.
    """
    return tuple(
        _costing(each, what_is_loose(clothing) + _standing_off(clothing), waist_cm, weighed_cm)
        if each.code == Code.CLOTHES_LOOSE and waist_cm is not None
        else each
        for each in findings
    )


def _costing(found: Remark, said: str, waist_cm: float, weighed_cm: float | None) -> Remark:
    remedy = "Close-fitting clothes make it surer."
    if weighed_cm is not None:
        remedy = f"With the weight it is known to ± {_half(weighed_cm)} cm. {remedy}"
    return replace(
        found,
        reason=(
            f"{said}: the body under them is estimated, the smallest waist to "
            f"± {_half(waist_cm)} cm (95 % of true values fall within)."
        ),
        remedy=remedy,
    )


def _standing_off(clothing: Sequence[WornRegion]) -> str:
    """More of that sentence: how far clothes stand off the trunk, where an outline shows it."""
    for each in clothing:
        if each.region is BodyRegion.UPPER and each.ease_cm is not None:
            return f", about {max(each.ease_cm, 0.0):.0f} cm off the upper body"
    return ""


def _half(standard_error: float) -> str:
    """Half the breadth of the 95 % interval."""
    return f"{INTERVAL_SD * standard_error:.0f}"


_NOT_LOOSE = remark(
    Note.CLOTHES_NOT_LOOSE,
    "Trunk and thighs show much of the colour of the person's skin, as in underwear or "
    "swimwear: girths may "
    "come out several centimetres too small.",
)
