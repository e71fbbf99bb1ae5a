"""What people of the clothed series wear: eight outfits by hand, the others drawn from a seed."""

from enum import StrEnum

import numpy as np

from tests.accuracy.scene import Bottom, Cloth, Outfit, Pattern, Rgb, Shoes, Top


class Wardrobe(StrEnum):
    """Classes of outfits."""

    T_SHIRT = "T-shirt, jeans"
    CLOSE = "close-fitting T-shirt, leggings"
    SHIRT_OUT = "shirt hanging out, trousers"
    HOODIE = "hoodie, jogging trousers"
    DRESS = "summer dress"
    BLOUSE = "blouse, knee skirt"
    TANK = "tank top, shorts"
    JACKET = "open jacket over a T-shirt, jeans"
    LIKE_SKIN = "T-shirt near the skin's colour, jeans"
    TRUNKS = "swim trunks alone"


_DENIM = Cloth(colour=(0.045, 0.075, 0.16), ease_m=0.025, fall=0.06, fold_m=0.005)
_KHAKI = Cloth(colour=(0.2, 0.17, 0.1), ease_m=0.03, fall=0.05, fold_m=0.006)
_BLACK = Cloth(colour=(0.02, 0.02, 0.023), ease_m=0.03, fall=0.04, fold_m=0.006)

SHIRT_AND_TROUSERS = Outfit(
    name=Wardrobe.SHIRT_OUT.value,
    top=Top(cloth=Cloth(colour=(0.55, 0.56, 0.57), ease_m=0.03, fall=0.16)),
    bottom=Bottom(cloth=_DENIM),
)
DRESS = Outfit(
    name=Wardrobe.DRESS.value,
    top=Top(
        cloth=Cloth(colour=(0.09, 0.13, 0.3), ease_m=0.035, fall=0.06, fold_m=0.009),
        sleeve=0.38,
        hem=0.25,
        neckline_m=0.05,
    ),
)
STRIPED_SHIRT_AND_TROUSERS = Outfit(
    name=Wardrobe.SHIRT_OUT.value,
    top=Top(
        cloth=Cloth(
            colour=(0.5, 0.5, 0.48),
            second_colour=(0.03, 0.05, 0.12),
            pattern=Pattern.STRIPES,
            ease_m=0.035,
            fall=0.14,
        )
    ),
    bottom=Bottom(cloth=_KHAKI),
)
BLOUSE_AND_SKIRT = Outfit(
    name=Wardrobe.BLOUSE.value,
    top=Top(
        cloth=Cloth(colour=(0.5, 0.42, 0.2), ease_m=0.03, fall=0.2, fold_m=0.005),
        sleeve=0.5,
        neckline_m=0.06,
        hem=0.5,
    ),
    bottom=Bottom(
        cloth=Cloth(colour=(0.14, 0.02, 0.05), ease_m=0.025, fall=-0.06, fold_m=0.01),
        waist=0.6,
        hem=0.3,
        skirt=True,
    ),
)
DRESS_OF_LINEN = Outfit(
    name=Wardrobe.DRESS.value,
    top=Top(
        cloth=Cloth(colour=(0.3, 0.32, 0.22), ease_m=0.045, fall=0.05, fold_m=0.009),
        sleeve=0.3,
        hem=0.27,
        neckline_m=0.05,
    ),
)
BLOUSE_AND_TROUSERS = Outfit(
    name=Wardrobe.SHIRT_OUT.value,
    top=Top(
        cloth=Cloth(colour=(0.3, 0.04, 0.06), ease_m=0.035, fall=0.14, fold_m=0.006),
        sleeve=0.55,
        neckline_m=0.05,
    ),
    bottom=Bottom(cloth=_BLACK, hem=0.1),
)
WIDE_SHIRT_AND_TROUSERS = Outfit(
    name=Wardrobe.SHIRT_OUT.value,
    top=Top(cloth=Cloth(colour=(0.1, 0.25, 0.45), ease_m=0.05, fall=0.1, fold_m=0.008)),
    bottom=Bottom(cloth=_KHAKI),
)
CHECKED_SHIRT_AND_TROUSERS = Outfit(
    name=Wardrobe.SHIRT_OUT.value,
    top=Top(
        cloth=Cloth(
            colour=(0.42, 0.42, 0.4),
            second_colour=(0.22, 0.03, 0.03),
            pattern=Pattern.CHECKS,
            ease_m=0.035,
            fall=0.13,
        ),
        sleeve=0.55,
    ),
    bottom=Bottom(cloth=_DENIM),
)

_BAREFOOT = 0.2
"""How often people in new outfits wear no shoes."""

_SNUG_FALL = 1.0
"""Steep enough for cloth to follow the body everywhere."""


def drawn_outfit(kind: Wardrobe, skin: Rgb, rng: np.random.Generator) -> Outfit:
    """An outfit of a class: cut, ease, cloth, colours, pattern and shoes at random."""
    top, bottom, jacket = None, _jeans(rng), None
    match kind:
        case Wardrobe.CLOSE:
            top = Top(
                cloth=_cloth(rng, ease=(0.004, 0.006), fall=(_SNUG_FALL, _SNUG_FALL), fold=0.0008),
                sleeve=_between(rng, 0.3, 0.45),
                hem=_between(rng, 0.49, 0.52),
                neckline_m=_between(rng, 0.02, 0.05),
                clearance_m=0.004,
            )
            bottom = Bottom(
                cloth=_plain(rng, ease=(0.003, 0.004), fall=(_SNUG_FALL, _SNUG_FALL), fold=0.0005),
                hem=_between(rng, 0.07, 0.16),
                clearance_m=0.0025,
            )
        case Wardrobe.HOODIE:
            top = Top(
                cloth=_plain(rng, ease=(0.035, 0.055), fall=(0.0, 0.05), fold=0.008),
                sleeve=0.97,
                hem=_between(rng, 0.44, 0.47),
                neckline_m=0.0,
                cuffs=True,
            )
            bottom = Bottom(
                cloth=_plain(rng, ease=(0.025, 0.04), fall=(0.0, 0.05), fold=0.008),
                hem=_between(rng, 0.065, 0.08),
                cuffs=True,
            )
        case Wardrobe.BLOUSE:
            top = Top(
                cloth=_cloth(rng, ease=(0.02, 0.035), fall=(0.12, 0.25), fold=0.006),
                sleeve=_between(rng, 0.4, 0.9),
                hem=_between(rng, 0.49, 0.52),
                neckline_m=_between(rng, 0.04, 0.07),
            )
            bottom = Bottom(
                cloth=_plain(rng, ease=(0.015, 0.03), fall=(-0.15, 0.05), fold=0.008),
                waist=0.6,
                hem=_between(rng, 0.25, 0.31),
                skirt=True,
            )
        case Wardrobe.TANK:
            top = Top(
                cloth=_cloth(rng, ease=(0.008, 0.022), fall=(0.12, 0.3), fold=0.004),
                sleeve=0.0,
                hem=_between(rng, 0.46, 0.49),
                neckline_m=_between(rng, 0.06, 0.09),
                clearance_m=0.009,
            )
            bottom = _shorts(rng)
        case Wardrobe.TRUNKS:
            bottom = _shorts(rng)
        case Wardrobe.JACKET:
            top = _t_shirt(rng, ease=(0.012, 0.02))
            jacket = Top(
                cloth=_plain(rng, ease=(0.04, 0.06), fall=(0.02, 0.12), fold=0.006),
                sleeve=_between(rng, 0.93, 1.0),
                hem=top.hem - _between(rng, 0.0, 0.03),
                neckline_m=0.0,
                opening_m=_between(rng, 0.06, 0.11),
                clearance_m=0.022,
            )
        case Wardrobe.LIKE_SKIN:
            red, green, blue = np.array(skin) * np.exp(rng.normal(0.0, 0.1, 3))
            near = (round(float(red), 4), round(float(green), 4), round(float(blue), 4))
            top = _t_shirt(rng, ease=(0.015, 0.03), colour=near)
        case _:
            top = _t_shirt(rng, ease=(0.015, 0.03))
    shoes = None
    if rng.random() > _BAREFOOT and kind is not Wardrobe.TRUNKS:
        shoes = Shoes(
            colour=_colour(rng),
            sole_colour=(0.5, 0.5, 0.48) if rng.random() < 0.5 else (0.04, 0.035, 0.03),
            sole_m=_between(rng, 0.01, 0.03),
        )
    return Outfit(name=kind.value, top=top, bottom=bottom, jacket=jacket, shoes=shoes)


def _t_shirt(
    rng: np.random.Generator, *, ease: tuple[float, float], colour: Rgb | None = None
) -> Top:
    cloth = (
        _cloth(rng, ease=ease, fall=(0.1, 0.2), fold=0.005)
        if colour is None
        else _plain(rng, ease=ease, fall=(0.1, 0.2), fold=0.005, colour=colour)
    )
    return Top(
        cloth=cloth,
        sleeve=_between(rng, 0.32, 0.48),
        hem=_between(rng, 0.45, 0.48),
        neckline_m=_between(rng, 0.02, 0.04),
    )


def _jeans(rng: np.random.Generator) -> Bottom:
    depth = _between(rng, 0.4, 1.6)
    blue: Rgb = (0.045 * depth, 0.07 * depth, 0.14 * depth)
    cloth = _plain(rng, ease=(0.015, 0.03), fall=(0.05, 0.13), fold=0.005, colour=blue)
    return Bottom(cloth=cloth, hem=_between(rng, 0.035, 0.055))


def _shorts(rng: np.random.Generator) -> Bottom:
    cloth = _cloth(rng, ease=(0.02, 0.035), fall=(-0.1, 0.05), fold=0.006)
    return Bottom(cloth=cloth, waist=_between(rng, 0.565, 0.59), hem=_between(rng, 0.29, 0.37))


def _cloth(
    rng: np.random.Generator, *, ease: tuple[float, float], fall: tuple[float, float], fold: float
) -> Cloth:
    """Plain in half of the cases, else striped or checked."""
    pattern = Pattern(rng.choice([*Pattern, Pattern.PLAIN]))
    second = _colour(rng)
    return Cloth(
        colour=_colour(rng),
        second_colour=second,
        pattern=pattern,
        ease_m=_between(rng, *ease),
        fall=_between(rng, *fall),
        fold_m=fold,
    )


def _plain(
    rng: np.random.Generator,
    *,
    ease: tuple[float, float],
    fall: tuple[float, float],
    fold: float,
    colour: Rgb | None = None,
) -> Cloth:
    return Cloth(
        colour=_colour(rng) if colour is None else colour,
        ease_m=_between(rng, *ease),
        fall=_between(rng, *fall),
        fold_m=fold,
    )


def _colour(rng: np.random.Generator) -> Rgb:
    """Linear light: dark and light cloths alike often, greys more often than bright colours."""
    light = float(np.exp(rng.uniform(np.log(0.02), np.log(0.6))))
    red, green, blue = np.minimum(light * np.exp(rng.normal(0.0, 0.45, 3)), 0.75)
    return (round(float(red), 4), round(float(green), 4), round(float(blue), 4))


def _between(rng: np.random.Generator, low: float, high: float) -> float:
    return round(float(rng.uniform(low, high)), 4)
