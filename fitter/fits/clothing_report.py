"""Report of clothes: how each region is covered, how the outline was taken, the doubts."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from fitter.arrays import GreyImage, Mask
from fitter.energies.objective import Candidate, Objective
from fitter.measurement.definitions import INTERVAL_SD
from fitter.optimizer.uncertainty import Certainty, covered_distances, waist_distance
from fitter.segmentation.coverage import Coverage
from fitter.segmentation.skin_colour import LEAST_SAMPLES, PersonRegions, SkinMap
from fitter.vocabulary.choices import BodyRegion, Clothing, Covering
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

SAID_LOOSE: Final = frozenset({Clothing.LOOSE, Clothing.OUTER})
_UNDER_TOP: Final = frozenset({BodyRegion.UPPER, BodyRegion.ARMS})
_MOST_OF: Final = 0.5


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
        told = distances.get(each.region)
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
    return (_NOT_LOOSE,) if SAID_LOOSE & said and undressed else ()


def with_what_is_worn(
    findings: Sequence[Remark], objective: Objective, body: Candidate
) -> tuple[Remark, ...]:
    """The findings; that of loose clothes with what they are and how far they stand off."""
    clothes, off_m = objective.evidence.clothes, waist_distance(objective, body)
    if clothes is None or off_m is None:
        return tuple(findings)
    off_cm = round(CENTIMETRES_PER_METRE * off_m)
    lies = f"stands about {off_cm} cm off" if off_cm > 0 else "lies close to"
    return _told_more(findings, f"{_WORN[clothes.over_top]} {lies} the body at the waist.")


def with_what_clothes_cost(
    findings: Sequence[Remark], waist_cm: float | None, weighed_cm: float | None
) -> tuple[Remark, ...]:
    """The findings; that of loose clothes with how well the waist is known, and would be.

    Parameters
    ----------
    waist_cm
        Standard error of the smallest waist; None where nothing is measured.
    weighed_cm
        The same if the weight were known; None if it is.
    """
    if waist_cm is None:
        return tuple(findings)
    remedy = "Close-fitting clothes make it surer."
    if weighed_cm is not None:
        remedy = f"Say the weight: the waist is then known to ± {_half(weighed_cm)} cm. {remedy}"
    said = (
        f"The smallest waist is known to ± {_half(waist_cm)} cm (95 % of true values fall within)."
    )
    return _told_more(findings, said, remedy)


def _told_more(
    findings: Sequence[Remark], said: str, remedy: str | None = None
) -> tuple[Remark, ...]:
    return tuple(
        replace(each, reason=f"{each.reason} {said}", remedy=remedy or each.remedy)
        if each.code == Code.CLOTHES_LOOSE
        else each
        for each in findings
    )


def _half(standard_error: float) -> str:
    """Half the breadth of the 95 % interval."""
    return f"{INTERVAL_SD * standard_error:.0f}"


_WORN: Final = {
    True: "A jacket, coat, vest or open shirt over the top",
    False: "The top, with nothing seen over it,",
    None: "What covers the trunk",
}
_NOT_LOOSE = remark(
    Note.CLOTHES_NOT_LOOSE,
    "The person seems to be in underwear or swimwear: girths may come out several centimetres too "
    "small.",
)
