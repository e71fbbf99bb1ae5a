"""Who of the suite's people wears what.

Eight were dressed by hand. The other sixteen, eight a half, wear one outfit of each of eight
classes: who wears which, how it is cut and coloured, and in what stance they stand, is drawn from a
seed.
"""

from dataclasses import dataclass, replace

import numpy as np

from tests.accuracy.outfits import (
    BLOUSE_AND_SKIRT,
    BLOUSE_AND_TROUSERS,
    CHECKED_SHIRT_AND_TROUSERS,
    DRESS,
    DRESS_OF_LINEN,
    SHIRT_AND_TROUSERS,
    STRIPED_SHIRT_AND_TROUSERS,
    WIDE_SHIRT_AND_TROUSERS,
    Wardrobe,
    drawn_outfit,
)
from tests.accuracy.people_table import PEOPLE, SITTERS, Sitter
from tests.accuracy.scene import Half, Look, Outfit, Stance
from tests.accuracy.stance_kinds import (
    ASTRIDE,
    AT_EASE,
    STANCES,
    THREE_QUARTERS,
    UPRIGHT,
    Kind,
)

SEED = 20261125

DRAWN = (
    Wardrobe.T_SHIRT,
    Wardrobe.CLOSE,
    Wardrobe.HOODIE,
    Wardrobe.BLOUSE,
    Wardrobe.TANK,
    Wardrobe.JACKET,
    Wardrobe.LIKE_SKIN,
    Wardrobe.TRUNKS,
)
"""Once each in either half; shirts and dresses are among those dressed by hand."""

WOMEN_ALONE, MEN_ALONE = frozenset({Wardrobe.BLOUSE}), frozenset({Wardrobe.TRUNKS})

PAIRS_OF_HALF = 3
"""People of either half who are shown from front and side in their clothes."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Dressed:
    """A person, by name, with what they wear and how they stand."""

    person: str
    stance: Stance
    outfit: Outfit


_BY_HAND = tuple(
    Dressed(person=person, stance=stance, outfit=outfit)
    for person, stance, outfit in (
        ("woman_young_thin", UPRIGHT, SHIRT_AND_TROUSERS),
        ("woman_old_heavy", ASTRIDE, DRESS),
        ("man_middle_aged_middling", AT_EASE, STRIPED_SHIRT_AND_TROUSERS),
        ("woman_middle_aged_middling", THREE_QUARTERS, BLOUSE_AND_SKIRT),
        ("woman_193_young_thin", AT_EASE, DRESS_OF_LINEN),
        ("woman_101_middle_aged_middling", UPRIGHT, BLOUSE_AND_TROUSERS),
        ("man_105_young_thin", ASTRIDE, WIDE_SHIRT_AND_TROUSERS),
        ("man_122_middle_aged_middling", UPRIGHT, CHECKED_SHIRT_AND_TROUSERS),
    )
)


def _drawn(half: Half, rng: np.random.Generator) -> list[Dressed]:
    by_hand = {each.person for each in _BY_HAND}
    sitters = [
        each for each in SITTERS if each.source.half is half and each.source.name not in by_hand
    ]
    kinds = list(DRAWN)
    while not all(map(_suits, sitters, kinds)):
        kinds = [DRAWN[number] for number in rng.permutation(len(DRAWN))]
    stances = (*STANCES[Kind.STANDING], THREE_QUARTERS)
    return [
        Dressed(
            person=sitter.source.name,
            stance=stances[rng.integers(len(stances))],
            outfit=drawn_outfit(kind, sitter.look.skin, rng),
        )
        for sitter, kind in zip(sitters, kinds, strict=True)
    ]


def _suits(sitter: Sitter, kind: Wardrobe) -> bool:
    woman = sitter.source.name.startswith("woman")
    return kind not in (MEN_ALONE if woman else WOMEN_ALONE)


def look_under(look: Look, outfit: Outfit) -> Look:
    """Underwear has no folds under close-fitting clothes."""
    close = outfit.name == Wardrobe.CLOSE
    return replace(look, clothes_relief_m=0.0) if close else look


_RNG = np.random.default_rng(SEED)

DRESSED: tuple[Dressed, ...] = (
    *_BY_HAND,
    *(each for half in Half for each in _drawn(half, _RNG)),
)

IN_PAIRS: tuple[str, ...] = tuple(
    from_the_front[number]
    for half in Half
    for from_the_front in [
        [
            each.person
            for each in DRESSED
            if PEOPLE[each.person].half is half and each.stance is not THREE_QUARTERS
        ]
    ]
    for number in sorted(_RNG.choice(len(from_the_front), PAIRS_OF_HALF, replace=False))
)
"""People who are shown from front and side in their clothes, drawn too."""
