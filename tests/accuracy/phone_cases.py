"""Phone pairs: each person from the front and from the side, as a phone stands or is held upright.

Camera, lamp and room stay as they are while the person turns. Two people are shown in five more
pairs, each in another room and light, from another distance and in another stance: what a
measurement changes by from one pair to the next is how well it repeats.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from tests.accuracy.people_table import SITTERS, Sitter
from tests.accuracy.scene import (
    Arm,
    Case,
    Floor,
    FocalLength,
    Lamp,
    Leg,
    Lighting,
    Series,
    Stance,
    Surroundings,
    View,
    Wall,
)
from tests.accuracy.variation import unsteady

EQUIVALENT_MM = 26
"""Of most phones' main camera."""

NEAREST_M, FARTHEST_M = 1.9, 2.4
LOWEST_M, HIGHEST_M = 1.1, 1.5

SMALL, LARGE = (480, 640), (720, 960)
EVERY_LARGE = 5
"""One pair in so many is larger."""

PLAIN_ROOMS = (
    Surroundings(wall_colour=(0.52, 0.5, 0.46), floor=Floor.WOOD, floor_colour=(0.26, 0.16, 0.09)),
    Surroundings(wall=Wall.CANVAS, wall_colour=(0.3, 0.31, 0.33)),
    Surroundings(
        wall_colour=(0.36, 0.42, 0.46), floor=Floor.CARPET, floor_colour=(0.16, 0.15, 0.14)
    ),
    Surroundings(wall_colour=(0.46, 0.37, 0.3), floor_colour=(0.32, 0.3, 0.28)),
)

BUSY_ROOMS = (
    Surroundings(
        wall=Wall.SHELVES,
        floor=Floor.WOOD,
        wall_colour=(0.2, 0.11, 0.06),
        floor_colour=(0.25, 0.15, 0.09),
    ),
    Surroundings(wall=Wall.BRICK, wall_colour=(0.3, 0.13, 0.085), floor_colour=(0.25, 0.25, 0.25)),
    Surroundings(
        wall=Wall.STRIPES,
        floor=Floor.CARPET,
        wall_colour=(0.45, 0.41, 0.33),
        floor_colour=(0.1, 0.13, 0.19),
    ),
    Surroundings(
        wall=Wall.BOARDS,
        floor=Floor.CONCRETE,
        wall_colour=(0.34, 0.25, 0.16),
        floor_colour=(0.2, 0.19, 0.18),
    ),
)


class SideArms(StrEnum):
    """Where a person has their arms when seen from the side."""

    STRETCHED = "stretched"
    HANGING = "hanging"


@dataclass(frozen=True, slots=True, kw_only=True)
class PhonePair:
    """One person from the front and from the side."""

    front: Case
    side: Case

    @property
    def person(self) -> str:
        """The person's name."""
        return self.front.person


def _pair(
    sitter: Sitter,
    *,
    name: str,
    series: Series,
    number: int,
    seed: int,
    arms: SideArms,
) -> PhonePair:
    """The pair of a seed; ``number`` chooses room and size."""
    rng = np.random.default_rng([seed, 3])
    front = Case(
        name=f"{name}_front",
        person=sitter.source.name,
        series=series,
        stance=unsteady(_from_the_front(sitter, rng), rng),
        view=_view(sitter, LARGE if number % EVERY_LARGE == EVERY_LARGE - 1 else SMALL, rng),
        lighting=_room_light(rng),
        surroundings=_room(number, rng),
        look=sitter.look,
        focal_length=FocalLength.EXIF,
        seed=seed,
        surface_seed=seed,
    )
    stance = stance_from_the_side(sitter, arms, rng)
    return PhonePair(
        front=front, side=replace(front, name=f"{name}_side", stance=stance, seed=seed + 1)
    )


def stance_from_the_side(sitter: Sitter, arms: SideArms, rng: np.random.Generator) -> Stance:
    """Turned to either side."""
    facing = float(rng.choice((-90.0, 90.0)))
    return unsteady(_from_the_side(sitter, arms, facing, rng), rng)


def _from_the_front(sitter: Sitter, rng: np.random.Generator) -> Stance:
    """Arms off the trunk, legs a little apart."""
    left_arm, right_arm = (
        Arm(
            raised=float(rng.uniform(34.5, 40.5)),
            forward=float(rng.uniform(-4.0, 12.0)),
            bend=float(rng.uniform(6.0, 18.0)),
        )
        for _ in range(2)
    )
    left_leg, right_leg = (
        Leg(raised=float(rng.uniform(4.5, 8.0)) + sitter.legs, bend=2.0) for _ in range(2)
    )
    return Stance(
        left_arm=left_arm,
        right_arm=right_arm,
        left_leg=left_leg,
        right_leg=right_leg,
        free_leg=str(rng.choice(("left", "right"))),
    )


def _from_the_side(
    sitter: Sitter, arms: SideArms, facing: float, rng: np.random.Generator
) -> Stance:
    """In profile, feet together or a little apart."""
    arm = _stretched if arms is SideArms.STRETCHED else _hanging
    swing = float(rng.choice((-1.0, 1.0)))
    left_arm, right_arm = (arm(sitter, swing, rng) for _ in range(2))
    apart = float(rng.uniform(2.0, 6.0)) + sitter.legs
    left_leg, right_leg = (
        Leg(raised=_raised(apart, ahead), forward=_forward(apart, ahead), bend=2.0)
        for ahead in rng.uniform(-2.0, 2.0, size=2)
    )
    return Stance(
        facing=facing,
        left_arm=left_arm,
        right_arm=right_arm,
        left_leg=left_leg,
        right_leg=right_leg,
        free_leg=str(rng.choice(("left", "right"))),
    )


def _stretched(sitter: Sitter, swing: float, rng: np.random.Generator) -> Arm:
    """Stretched forward, level or a little lower."""
    return Arm(raised=float(rng.uniform(78.0, 88.0)), forward=88.0, bend=float(rng.uniform(4, 12)))


def _hanging(sitter: Sitter, swing: float, rng: np.random.Generator) -> Arm:
    """Hanging, a little before (``swing`` 1) or behind (-1) the trunk's middle."""
    aside = 16.0 + 1.1 * sitter.arms
    ahead = float(rng.uniform(5.0, 14.0) if swing > 0.0 else rng.uniform(-12.0, -4.0))
    return Arm(
        raised=_raised(aside, ahead),
        forward=_forward(aside, ahead),
        bend=float(rng.uniform(6.0, 16.0)),
    )


def _raised(aside: float, ahead: float) -> float:
    return float(np.hypot(aside, ahead))


def _forward(aside: float, ahead: float) -> float:
    return float(np.degrees(np.arctan2(ahead, aside)))


def _view(sitter: Sitter, size: tuple[int, int], rng: np.random.Generator) -> View:
    """About two metres away, looking a little down."""
    width, height = size
    return View(
        width=width,
        height=height,
        equivalent_mm=EQUIVALENT_MM,
        distance_m=round(float(rng.uniform(NEAREST_M, FARTHEST_M)), 2),
        height_m=round(float(rng.uniform(LOWEST_M, HIGHEST_M)), 2),
        aim_height_m=round(float(rng.uniform(0.48, 0.56)) * sitter.source.stature_m, 2),
        aim_aside_m=round(float(rng.uniform(-0.08, 0.08)), 2),
    )


def _room_light(rng: np.random.Generator) -> Lighting:
    """A lamp on either side and more light from all round than a studio has."""
    side = float(rng.choice((-1.0, 1.0)))
    ambient = round(float(rng.uniform(0.2, 0.4)), 2)
    return Lighting(
        lamp=Lamp(
            azimuth=round(side * float(rng.uniform(18.0, 68.0)), 1),
            elevation=round(float(rng.uniform(18.0, 52.0)), 1),
            distance_m=round(float(rng.uniform(2.3, 3.4)), 2),
            strength=round(float(rng.uniform(0.6, 0.85)), 2),
        ),
        ambient=(ambient, ambient, ambient),
    )


def _room(number: int, rng: np.random.Generator) -> Surroundings:
    """Plain and busy rooms in turn."""
    rooms = BUSY_ROOMS if number % 2 else PLAIN_ROOMS
    distance_m = round(float(rng.uniform(0.8, 1.8)), 2)
    return replace(rooms[(number // 2) % len(rooms)], wall_distance_m=distance_m)


def arms_in_turn(count: int) -> SideArms:
    """Stretched and hanging in turn."""
    return SideArms.HANGING if count % 2 else SideArms.STRETCHED


def _pairs() -> dict[str, PhonePair]:
    """Arms are the other way round when the rooms come again, so that each room sees both."""
    rooms = len(PLAIN_ROOMS) + len(BUSY_ROOMS)
    return {
        f"phone_{sitter.source.name}": _pair(
            sitter,
            name=f"phone_{sitter.source.name}",
            series=Series.PHONE,
            number=number,
            seed=400 + 2 * number,
            arms=arms_in_turn(number // 2 + number // rooms),
        )
        for number, sitter in enumerate(SITTERS)
    }


PHONE_PAIRS: Mapping[str, PhonePair] = _pairs()
"""One pair of each person."""

PHONE_CASES: tuple[Case, ...] = tuple(
    case for pair in PHONE_PAIRS.values() for case in (pair.front, pair.side)
)
