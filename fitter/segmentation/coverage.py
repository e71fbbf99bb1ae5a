"""Coverage of a person's trunk and thighs, by how much of them shows the skin's colour.

A person wears one of few outfits: underwear, a swimsuit, nothing above the hips or at all, trousers
alone, shorts alone, a top with trousers, or a top with shorts, a skirt or a dress; tops may leave
the midriff bare, as open vests do. Each foretells which share of chest, waist, pelvis, thighs and
shins shows the colour of the skin, as a beta distribution; shadows, gloss and patterns are an even
share of outliers. Cloth may have the skin's colour: a top or a bottom then shows all of it. Bayes'
rule over outfits and their colours gives the probability that a region is covered, and that what
covers it cannot be told from skin by its colour.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from itertools import chain
from typing import Final

import numpy as np
from scipy.stats import beta

from fitter.arrays import GreyImage, Mask
from fitter.segmentation.skin_colour import LEAST_SAMPLES, PersonRegions, SkinMap, nearest_part

REGIONS: Final[Mapping[str, tuple[str, ...]]] = {
    "chest": ("chest",),
    "waist": ("spine",),
    "pelvis": ("pelvis",),
    "thighs": ("left_thigh", "right_thigh"),
    "shins": ("left_shin", "right_shin"),
}
"""Parts of the body model whose share of skin is looked at."""

SAME_COLOUR: Final = 0.04
"""Probability that a garment has about the colour of its wearer's skin."""

_OUTLIERS: Final = 0.05


class Covers(Enum):
    """Covers of trunk and legs by an outfit."""

    TOP = "top"
    BOTTOM = "bottom"


@dataclass(frozen=True, slots=True, kw_only=True)
class _Outfit:
    """``shares`` of skin by region, beta distributions by mean and number; what is covered."""

    prior: float
    bare_midriff: bool = False
    covers: frozenset[Covers]
    shares: Mapping[str, tuple[float, float]]


_NONE = (0.03, 20.0)
_UNDERWEAR_PELVIS = (0.3, 2.5)

# Of the tuning halves' people in underwear chests of women show 0.37 to 0.79 and of men 0.45 to
# 1, waists 0.13 to 1, thighs 0.35 to 1: light alone makes half of the differences.
_BY_GENDER: Final[Mapping[str, tuple[_Outfit, ...]]] = {
    gender: (
        _Outfit(
            prior=0.3,
            covers=frozenset(),
            shares={
                "chest": chest,
                "waist": waist,
                "pelvis": _UNDERWEAR_PELVIS,
                "thighs": (0.62, 5.0),
                "shins": (0.82, 6.0),
            },
        ),
        _Outfit(
            prior=0.03,
            covers=frozenset(),
            shares={
                "chest": (0.93, 10.0),
                "waist": (0.88, 6.0),
                "pelvis": (0.5, 1.5),
                "thighs": (0.75, 4.0),
                "shins": (0.82, 6.0),
            },
        ),
        _Outfit(
            prior=0.05,
            covers=frozenset({Covers.BOTTOM}),
            shares={
                "chest": chest,
                "waist": waist,
                "pelvis": (0.12, 8.0),
                "thighs": _NONE,
                "shins": _NONE,
            },
        ),
        _Outfit(
            prior=0.02,
            covers=frozenset({Covers.BOTTOM}),
            shares={
                "chest": chest,
                "waist": waist,
                "pelvis": (0.12, 8.0),
                "thighs": (0.12, 8.0),
                "shins": (0.8, 5.0),
            },
        ),
        _Outfit(
            prior=0.4,
            covers=frozenset({Covers.TOP, Covers.BOTTOM}),
            shares={
                "chest": (0.1, 12.0),
                "waist": _NONE,
                "pelvis": _NONE,
                "thighs": _NONE,
                "shins": (0.06, 8.0),
            },
        ),
        _Outfit(
            prior=0.25,
            covers=frozenset({Covers.TOP, Covers.BOTTOM}),
            shares={
                "chest": (0.15, 10.0),
                "waist": _NONE,
                "pelvis": _NONE,
                "thighs": (0.15, 4.0),
                "shins": (0.8, 5.0),
            },
        ),
        *(
            _Outfit(
                prior=0.02,
                bare_midriff=True,
                covers=frozenset({Covers.TOP, Covers.BOTTOM}),
                shares={
                    "chest": (0.3, 4.0),
                    "waist": (0.8, 6.0),
                    "pelvis": (0.12, 8.0),
                    "thighs": thighs,
                    "shins": shins,
                },
            )
            for thighs, shins in ((_NONE, (0.06, 8.0)), ((0.15, 4.0), (0.8, 5.0)))
        ),
    )
    for gender, chest, waist in (
        ("female", (0.57, 16.0), (0.66, 5.0)),
        ("male", (0.93, 10.0), (0.88, 6.0)),
    )
}

SEEN_BARE: Final = {"chest": (0.33, 6.0), "waist": (0.28, 5.0), "thighs": (0.4, 3.0)}
SEEN_UNDER_TOP: Final = {"chest": (0.08, 5.0), "waist": (0.04, 8.0)}
SEEN_MIDRIFF, SEEN_BELOW_SHORTS = (0.18, 8.0), (0.2, 4.0)
"""Shares that a network takes for skin, as ``_Outfit.shares``. Of 150 people in underwear waists
have 0.05 to 0.6 and thighs 0.05 to 0.75, least from the side; covered waists of 16 real people in
two outfits, from the front and from behind, have 0 to 0.08 and four to 0.19."""

_AS_SKIN: Final[Mapping[Covers, Mapping[str, tuple[float, float]]]] = {
    Covers.TOP: {"chest": (0.95, 20.0), "waist": (0.85, 5.0), "pelvis": (0.5, 1.2)},
    Covers.BOTTOM: {"thighs": (0.85, 5.0)},
}
POOR_LIGHT: Final = 0.15
"""Probability of less skin colour on bare skin than in even light: gloss, shadows, other limbs."""

_IN_POOR_LIGHT: Final = (0.4, 2.5)
_BARE_FROM: Final = 0.3
_FOREARMS_BARE: Final = (0.6, 2.5)
_LOWEST, _HIGHEST = 0.005, 0.995

_UNDER_BOTTOM: Final = frozenset({"pelvis", "thigh", "shin", "foot"})
_LIKE_SKIN: Final[Mapping[str, float]] = {"chest": 0.9, "spine": 1.0, "upper_arm": 0.5}
"""Share of a part that a top hides."""

_BELIEVED: Final[Mapping[str, float]] = {"chest": 0.5, "spine": 0.1}
"""Under a top skin shows at the neckline at most: its colour elsewhere is the garment's."""

_AT_MIDRIFF: Final = 0.9
"""Share of chest and waist in sight where a top leaves the midriff bare: open vests and short tops.
The frequency of such tops is a guess. Below a chest of which a quarter is skin a midriff is bare
with probability 0.6, and was with 0.2 to 0.3 where no outfit had one."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Coverage:
    """Probabilities, of the trunk and of pelvis and thighs.

    Attributes
    ----------
    top, bottom
        That it is covered by more than underwear.
    top_like_skin, bottom_like_skin
        That it is, by cloth of the skin's colour.
    bare_midriff
        That the trunk is covered and the waist in sight, as under an open vest.
    """

    top: float
    bottom: float
    top_like_skin: float
    bottom_like_skin: float
    bare_midriff: float = 0.0

    @property
    def anything(self) -> float:
        """That trunk or legs are covered, at least."""
        return max(self.top, self.bottom)

    def bare(self, skin: SkinMap, regions: PersonRegions) -> GreyImage:
        """(h, w) probability that a pixel's part is bare.

        Parts of an uncovered region are bare whatever their colour: what is not skin there is
        underwear. Under a garment of the skin's colour skin cannot be told by it; a network can.
        """
        shares = np.array([self._shares(name) for name in regions.part_names])
        parts = nearest_part(regions)
        always, believed = shares[parts, 0], shares[parts, 1]
        if skin.by_network:
            believed = 1.0 - always
        return (always + believed * skin.probability).astype(np.float32)

    def _shares(self, part: str) -> tuple[float, float]:
        """Probabilities that a part is bare anyway, and where its colour says so."""
        kind = part.removeprefix("left_").removeprefix("right_")
        if kind in _UNDER_BOTTOM:
            hidden = {"thigh": self.bottom_like_skin, "pelvis": self.top_like_skin}
            like = min(hidden.get(kind, 0.0), self.bottom)
            return 1.0 - self.bottom, self.bottom - like
        told = self.top - _LIKE_SKIN.get(kind, 0.0) * self.top_like_skin
        believed = _BELIEVED.get(kind, 1.0)
        in_sight = max(_AT_MIDRIFF - believed, 0.0) * self.bare_midriff
        return 1.0 - self.top, believed * told + in_sight


def coverage(skin: SkinMap, regions: PersonRegions, gender: str | None) -> Coverage:
    """Clothes of a person, from the share of skin on each region of a body near them.

    Where no colour was learnt, as in a grey picture, trunk and legs are taken to be covered: people
    in pictures mostly are. Of a gender that is not known, it is what either wears.
    """
    if not skin.learnt_from:
        return Coverage(top=1.0, bottom=1.0, top_like_skin=0.0, bottom_like_skin=0.0)
    outfits = chain(*_BY_GENDER.values()) if gender is None else _BY_GENDER[gender]
    coloured = region_means(skin.coloured, regions)
    seen = region_means(skin.probability, regions) if skin.by_network else {}
    weights: list[float] = []
    states: list[tuple[frozenset[Covers], frozenset[Covers]]] = []
    midriffs: list[bool] = []
    for outfit in outfits:
        for like_skin in _subsets(outfit.covers):
            # Where the waist is seen, the colour is that of skin.
            if outfit.bare_midriff and Covers.TOP in like_skin:
                continue
            colours = SAME_COLOUR ** len(like_skin)
            colours *= (1.0 - SAME_COLOUR) ** (len(outfit.covers) - len(like_skin))
            # Less of a midriff in poor light may be that of a bare chest.
            poor = 0.0 if outfit.bare_midriff else POOR_LIGHT
            shares = dict(outfit.shares)
            for cover in like_skin:
                shares |= _AS_SKIN[cover]
            colours *= _likelihood_seen(outfit, seen)
            weights.append(outfit.prior * colours * _likelihood(shares, coloured, poor))
            states.append((outfit.covers, like_skin))
            midriffs.append(outfit.bare_midriff)
    probabilities = np.array(weights) / np.sum(weights)

    def of(which: int, cover: Covers) -> float:
        chosen = [cover in state[which] for state in states]
        return float(probabilities[chosen].sum())

    return Coverage(
        top=of(0, Covers.TOP),
        bottom=of(0, Covers.BOTTOM),
        top_like_skin=of(1, Covers.TOP),
        bottom_like_skin=of(1, Covers.BOTTOM),
        bare_midriff=float(probabilities[midriffs].sum()),
    )


def region_means(values: GreyImage | Mask, regions: PersonRegions) -> dict[str, float]:
    """The mean of values (h, w) over each region in sight."""
    shares: dict[str, float] = {}
    for region, parts in REGIONS.items():
        numbers = [regions.part_names.index(name) for name in parts if name in regions.part_names]
        seen = regions.person & np.isin(regions.parts, numbers)
        if np.count_nonzero(seen) >= LEAST_SAMPLES:
            shares[region] = float(np.mean(values[seen]))
    return shares


def bare_forearms(shown: float) -> float:
    """Probability that forearms are bare, by the share of them that shows skin.

    In the shade and at their rims bare ones may show little of it: those of 16 real people have
    0.15 to 0.97, and but one of 16 in long sleeves less than 0.14.
    """
    bare, covered = _density(_FOREARMS_BARE, shown), _density(_NONE, shown)
    return bare / (bare + covered)


def _subsets(covers: frozenset[Covers]) -> list[frozenset[Covers]]:
    found = [frozenset[Covers]()]
    for each in covers:
        found += [others | {each} for others in found]
    return found


def _likelihood(
    shares: Mapping[str, tuple[float, float]], seen: Mapping[str, float], poor_light: float
) -> float:
    """Likelihood of what is seen, in even or in poor light."""
    even, poor = 1.0 - poor_light, poor_light
    for region, share in seen.items():
        even *= _density(shares[region], share)
        mean, _ = shares[region]
        poor *= _density(_IN_POOR_LIGHT if mean > _BARE_FROM else shares[region], share)
    return even + poor


def _likelihood_seen(outfit: _Outfit, seen: Mapping[str, float]) -> float:
    """Likelihood of a network's shares, which depend less on light and on the colour of cloth."""
    shares = dict(SEEN_BARE)
    if Covers.TOP in outfit.covers:
        shares |= SEEN_UNDER_TOP
    if outfit.bare_midriff:
        shares["waist"] = SEEN_MIDRIFF
    if Covers.BOTTOM in outfit.covers:
        ends_above, _ = outfit.shares["shins"]
        shares["thighs"] = SEEN_BELOW_SHORTS if ends_above > _BARE_FROM else _NONE
    told = [_density(shares[region], seen[region]) for region in shares.keys() & seen.keys()]
    return float(np.prod(told))


def _density(share: tuple[float, float], seen: float) -> float:
    mean, number = share
    at = np.clip(seen, _LOWEST, _HIGHEST)
    return (1.0 - _OUTLIERS) * float(beta.pdf(at, mean * number, (1.0 - mean) * number)) + _OUTLIERS
