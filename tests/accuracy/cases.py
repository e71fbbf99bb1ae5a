"""The pictures of the suite: a table of people, rooms and stances, varied from seeds.

Three pictures of each person, one of each kind of stance, and one in clothes; eight of the tuning
half in unusual light; phone pairs, also in clothes; and the sample of ``maquette demo``.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from tests.accuracy.dressed_people import DRESSED, IN_PAIRS, Dressed, look_under
from tests.accuracy.people_table import PEOPLE, SITTERS, Sitter
from tests.accuracy.phone_cases import (
    PHONE_CASES,
    PhonePair,
    arms_in_turn,
    stance_from_the_side,
)
from tests.accuracy.scene import (
    Case,
    Floor,
    FocalLength,
    Lamp,
    Lighting,
    Rgb,
    Series,
    Stance,
    Surroundings,
    View,
    Wall,
)
from tests.accuracy.stance_kinds import (
    ARM_ACROSS,
    ASTRIDE,
    AT_EASE,
    CONTRAPPOSTO,
    STANCES,
    THREE_QUARTERS,
    UPRIGHT,
    Kind,
)
from tests.accuracy.variation import mirrored, opened, unsteady

__all__ = ("CASES", "CLOTHED_PAIRS", "DEMO", "PEOPLE")

DEMO = Case(
    name="demo",
    person="man_slim",
    series=Series.SAMPLE,
    stance=CONTRAPPOSTO,
    view=View(width=720, height=960, distance_m=2.95, aim_height_m=0.9),
    lighting=Lighting(lamp=Lamp(azimuth=-42.0, elevation=36.0, distance_m=2.6, strength=0.9)),
    surroundings=Surroundings(wall=Wall.CANVAS, wall_colour=(0.19, 0.22, 0.25)),
    focal_length=FocalLength.EXIF,
    seed=1,
)

ROOMS = (
    Surroundings(wall_colour=(0.45, 0.43, 0.38)),
    Surroundings(
        wall=Wall.CANVAS,
        floor=Floor.WOOD,
        wall_colour=(0.22, 0.19, 0.15),
        floor_colour=(0.16, 0.085, 0.05),
    ),
    Surroundings(wall=Wall.BRICK, wall_colour=(0.3, 0.13, 0.085), floor_colour=(0.25, 0.25, 0.25)),
    Surroundings(
        wall=Wall.BOARDS,
        floor=Floor.CARPET,
        wall_colour=(0.2, 0.26, 0.3),
        floor_colour=(0.2, 0.07, 0.06),
    ),
    Surroundings(floor=Floor.WOOD, wall_colour=(0.3, 0.34, 0.42), floor_colour=(0.3, 0.2, 0.12)),
    Surroundings(wall=Wall.CANVAS, wall_colour=(0.19, 0.22, 0.25)),
    Surroundings(
        wall=Wall.PLASTER,
        floor=Floor.CARPET,
        wall_colour=(0.38, 0.42, 0.36),
        floor_colour=(0.1, 0.13, 0.19),
    ),
    Surroundings(
        wall=Wall.BOARDS,
        floor=Floor.CONCRETE,
        wall_colour=(0.42, 0.36, 0.28),
        floor_colour=(0.2, 0.19, 0.18),
    ),
)

FOCAL_LENGTHS = (FocalLength.GIVEN, FocalLength.EXIF, FocalLength.GIVEN, FocalLength.MISSING)
"""Half given, a quarter in the file, a quarter nowhere."""

SIZES = ((480, 640), (480, 640), (480, 640), (600, 800), (540, 720))

FILLED = 0.84
"""Share of the picture's height that a person takes up."""

DIAGONAL_MM, SQUARE_SHARE = 43.2666, 0.8
"""Of 35 mm film, and a 3:4 picture's height as a share of its diagonal."""


def _view(stature_m: float, size: tuple[int, int], rng: np.random.Generator) -> View:
    """From two to four metres away, with the lens that shows the whole person."""
    distance_m = round(float(rng.uniform(2.1, 3.9)), 2)
    height_m = float(rng.uniform(0.55, 0.95)) * stature_m
    shown_m = stature_m / FILLED
    width, height = size
    return View(
        width=width,
        height=height,
        equivalent_mm=round(DIAGONAL_MM * SQUARE_SHARE * distance_m / shown_m),
        distance_m=distance_m,
        height_m=round(height_m, 2),
        aim_height_m=round(0.5 * stature_m, 2),
        aim_aside_m=round(float(rng.uniform(-0.06, 0.06)), 2),
    )


def _lighting(rng: np.random.Generator) -> Lighting:
    side = float(rng.choice((-1.0, 1.0)))
    ambient = round(float(rng.uniform(0.17, 0.3)), 2)
    return Lighting(
        lamp=Lamp(
            azimuth=round(side * float(rng.uniform(22.0, 62.0)), 1),
            elevation=round(float(rng.uniform(15.0, 48.0)), 1),
            distance_m=round(float(rng.uniform(2.3, 3.4)), 2),
            strength=round(float(rng.uniform(0.75, 0.95)), 2),
        ),
        ambient=(ambient, ambient, ambient),
    )


def _stance(sitter: Sitter, stance: Stance, rng: np.random.Generator) -> Stance:
    roomy = opened(stance, arms=sitter.arms, legs=sitter.legs)
    return unsteady(mirrored(roomy) if rng.random() < 0.5 else roomy, rng)


def _people() -> list[Case]:
    cases: list[Case] = []
    for row, sitter in enumerate(SITTERS):
        for column, kind in enumerate(Kind):
            number = len(Kind) * row + column
            seed = 100 + number
            rng = np.random.default_rng([seed, 3])
            cases.append(
                Case(
                    name=f"{sitter.source.name}_{kind.value}",
                    person=sitter.source.name,
                    series=Series.PEOPLE,
                    stance=_stance(sitter, STANCES[kind][(row + column) % 4], rng),
                    view=_view(sitter.source.stature_m, SIZES[number % len(SIZES)], rng),
                    lighting=_lighting(rng),
                    surroundings=ROOMS[(5 * row + 3 * column) % len(ROOMS)],
                    look=sitter.look,
                    focal_length=FOCAL_LENGTHS[number % len(FOCAL_LENGTHS)],
                    seed=seed,
                )
            )
    return cases


_SITTER = {sitter.source.name: sitter for sitter in SITTERS}


def _light(
    number: int,
    name: str,
    person: str,
    stance: Stance,
    *,
    lighting: Lighting | None = None,
    surroundings: Surroundings | None = None,
    skin: Rgb | None = None,
) -> Case:
    """A picture in which one thing about the light, the skin or the place is unusual."""
    sitter, seed = _SITTER[person], 200 + number
    rng = np.random.default_rng([seed, 3])
    return Case(
        name=f"light_{name}",
        person=person,
        series=Series.LIGHTS,
        stance=_stance(sitter, stance, rng),
        view=_view(sitter.source.stature_m, (480, 640), rng),
        lighting=lighting or _lighting(rng),
        surroundings=surroundings or ROOMS[number % len(ROOMS)],
        look=sitter.look if skin is None else replace(sitter.look, skin=skin),
        focal_length=FocalLength.GIVEN,
        seed=seed,
    )


def _grey(level: float) -> Rgb:
    return (level, level, level)


_SUN = Lamp(azimuth=35.0, elevation=40.0, distance_m=40.0, radius_m=0.3, strength=0.85)

_LIGHTS = (
    _light(0, "directional", "man_middle_aged_thin", AT_EASE, lighting=Lighting(lamp=_SUN)),
    _light(
        1,
        "two_lamps",
        "woman_young_thin",
        UPRIGHT,
        lighting=Lighting(
            lamp=Lamp(azimuth=-48.0, elevation=32.0, strength=0.75),
            second=Lamp(azimuth=60.0, elevation=20.0, strength=0.35),
            ambient=_grey(0.15),
        ),
    ),
    _light(
        2,
        "strong_ambient",
        "man_young_heavy",
        ASTRIDE,
        lighting=Lighting(lamp=Lamp(strength=0.4), ambient=_grey(0.55)),
    ),
    _light(
        3,
        "soft_lamp",
        "woman_old_heavy",
        THREE_QUARTERS,
        lighting=Lighting(
            lamp=Lamp(azimuth=40.0, elevation=30.0, distance_m=2.6, radius_m=0.5, strength=0.85)
        ),
    ),
    _light(4, "dark_skin", "man_young_heavy", UPRIGHT, skin=(0.085, 0.045, 0.03)),
    _light(5, "light_skin", "woman_middle_aged_middling", CONTRAPPOSTO, skin=(0.74, 0.56, 0.48)),
    _light(
        6,
        "busy_background",
        "man_old_middling",
        ARM_ACROSS,
        surroundings=Surroundings(
            wall=Wall.SHELVES,
            floor=Floor.WOOD,
            wall_colour=(0.2, 0.11, 0.06),
            floor_colour=(0.25, 0.15, 0.09),
        ),
    ),
    _light(
        7,
        "outdoors",
        "woman_middle_aged_middling",
        ASTRIDE,
        lighting=Lighting(
            lamp=replace(_SUN, azimuth=-52.0, elevation=46.0, strength=0.95),
            ambient=(0.17, 0.22, 0.3),
        ),
        surroundings=Surroundings(
            wall=Wall.HEDGE,
            floor=Floor.GRASS,
            wall_colour=(0.045, 0.085, 0.025),
            floor_colour=(0.1, 0.16, 0.05),
            wall_distance_m=2.2,
        ),
    ),
)


def _clothed(number: int, dressed: Dressed) -> Case:
    """A picture in clothes."""
    sitter, seed = _SITTER[dressed.person], 300 + number
    rng = np.random.default_rng([seed, 3])
    return Case(
        name=f"clothed_{dressed.person}",
        person=dressed.person,
        series=Series.CLOTHED,
        stance=_stance(sitter, dressed.stance, rng),
        view=_view(sitter.source.stature_m, (480, 640), rng),
        lighting=_lighting(rng),
        surroundings=ROOMS[(3 * number + 1) % len(ROOMS)],
        look=look_under(sitter.look, dressed.outfit),
        focal_length=FocalLength.GIVEN,
        outfit=dressed.outfit,
        seed=seed,
    )


_CLOTHED = tuple(_clothed(number, dressed) for number, dressed in enumerate(DRESSED))


def _clothed_pairs() -> dict[str, PhonePair]:
    """The person turns; camera, lamp and room stay as they are."""
    fronts = {case.person: case for case in _CLOTHED}
    pairs: dict[str, PhonePair] = {}
    for number, person in enumerate(IN_PAIRS):
        front, seed = fronts[person], 600 + number
        rng = np.random.default_rng([seed, 3])
        side = replace(
            front,
            name=f"{front.name}_side",
            series=Series.CLOTHED_PAIRS,
            stance=stance_from_the_side(_SITTER[person], arms_in_turn(number), rng),
            seed=seed,
            surface_seed=front.seed,
        )
        pairs[person] = PhonePair(front=front, side=side)
    return pairs


CLOTHED_PAIRS: Mapping[str, PhonePair] = _clothed_pairs()
"""People in their clothes whose one picture is from the front, with another from the side."""

_CLOTHED_SIDES = tuple(pair.side for pair in CLOTHED_PAIRS.values())

CASES: Mapping[str, Case] = {
    case.name: case
    for case in (DEMO, *_people(), *_LIGHTS, *_CLOTHED, *_CLOTHED_SIDES, *PHONE_CASES)
}
