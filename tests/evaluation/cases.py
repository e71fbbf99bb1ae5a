"""The people and the pictures of the suite."""

from collections.abc import Mapping

from fitter.request import Gender
from tests.evaluation.scene import (
    Arm,
    Case,
    Floor,
    FocalLength,
    Hair,
    Half,
    Leg,
    Lighting,
    Look,
    PersonSource,
    Stance,
    Surroundings,
    View,
    Wall,
)

_PEOPLE = (
    PersonSource(name="man_slim", gender=Gender.MALE, seed=2009030, half=Half.TUNING),
    PersonSource(name="woman_slim", gender=Gender.FEMALE, seed=2009007, half=Half.TUNING),
    PersonSource(name="woman_middling", gender=Gender.FEMALE, seed=2009026, half=Half.REPORTING),
    PersonSource(name="woman_heavy", gender=Gender.FEMALE, seed=2009013, half=Half.TUNING),
    PersonSource(name="man_thin", gender=Gender.MALE, seed=2009014, half=Half.REPORTING),
    PersonSource(name="man_middling", gender=Gender.MALE, seed=2009036, half=Half.TUNING),
    PersonSource(name="man_heavy", gender=Gender.MALE, seed=2009012, half=Half.REPORTING),
)

PEOPLE: Mapping[str, PersonSource] = {person.name: person for person in _PEOPLE}

CONTRAPPOSTO = Stance(
    facing=8.0,
    pelvis=(0.0, 0.0, -5.0),
    spine=(-2.0, 0.0, 4.0),
    chest=(0.0, -2.0, 3.0),
    neck=(2.0, -4.0, 0.0),
    head=(2.0, -8.0, -2.0),
    left_arm=Arm(raised=20.0, forward=15.0, bend=16.0),
    right_arm=Arm(raised=45.0, forward=-30.0, turn=-50.0, bend=85.0),
    left_leg=Leg(raised=9.0, forward=55.0, turn=18.0, toe_out=25.0),
    right_leg=Leg(raised=2.0, bend=1.0),
    free_leg="left",
)
"""Weight on the right leg, right hand at the hip."""

UPRIGHT = Stance(
    facing=-6.0,
    chest=(0.0, 3.0, 0.0),
    head=(2.0, 4.0, 0.0),
    left_arm=Arm(raised=22.0, forward=5.0, bend=12.0),
    right_arm=Arm(raised=26.0, forward=0.0, bend=18.0),
    left_leg=Leg(raised=6.0, bend=2.0),
    right_leg=Leg(raised=6.0, bend=2.0),
    free_leg="right",
)
"""Both feet on the ground, arms a little away."""

TURNED = Stance(
    facing=38.0,
    pelvis=(0.0, 0.0, 4.0),
    spine=(-3.0, -4.0, -3.0),
    chest=(-2.0, -6.0, -3.0),
    head=(0.0, -14.0, 0.0),
    left_arm=Arm(raised=16.0, forward=-50.0, bend=22.0),
    right_arm=Arm(raised=22.0, forward=40.0, bend=35.0),
    left_leg=Leg(raised=3.0, bend=2.0),
    right_leg=Leg(raised=12.0, forward=70.0, turn=8.0, toe_out=15.0),
    free_leg="right",
)
"""Three quarters to the left, right foot ahead."""

STRIDING = Stance(
    facing=-32.0,
    spine=(3.0, 5.0, 0.0),
    chest=(2.0, 6.0, 0.0),
    head=(0.0, 8.0, 0.0),
    left_arm=Arm(raised=30.0, forward=75.0, bend=35.0),
    right_arm=Arm(raised=26.0, forward=-60.0, bend=20.0),
    left_leg=Leg(raised=16.0, forward=-85.0, bend=15.0, heel_up=12.0),
    right_leg=Leg(raised=16.0, forward=85.0, bend=4.0, toe_out=6.0),
    free_leg="left",
)
"""Walking past the camera."""

ARM_ACROSS = Stance(
    facing=5.0,
    spine=(0.0, 2.0, 0.0),
    neck=(3.0, 0.0, 0.0),
    head=(4.0, 5.0, 3.0),
    left_arm=Arm(raised=20.0, forward=-10.0, turn=-42.0, bend=88.0),
    right_arm=Arm(raised=24.0, forward=0.0, bend=14.0),
    left_leg=Leg(raised=5.0, bend=2.0),
    right_leg=Leg(raised=8.0, forward=30.0, bend=8.0, toe_out=15.0),
    free_leg="right",
)
"""The left forearm before the trunk."""

HAND_RAISED = Stance(
    facing=12.0,
    pelvis=(0.0, 0.0, 4.0),
    spine=(0.0, 0.0, -4.0),
    chest=(0.0, -3.0, -2.0),
    head=(4.0, -6.0, 4.0),
    left_arm=Arm(raised=26.0, forward=60.0, turn=-12.0, bend=32.0),
    right_arm=Arm(raised=55.0, forward=45.0, turn=-15.0, bend=125.0),
    left_leg=Leg(raised=2.0, bend=1.0),
    right_leg=Leg(raised=10.0, forward=50.0, turn=15.0, toe_out=22.0),
    free_leg="right",
)
"""The right hand at the shoulder, the left one before the thigh."""

DEMO = Case(
    name="demo",
    person="man_slim",
    stance=CONTRAPPOSTO,
    view=View(width=720, height=960, distance_m=2.95, aim_height_m=0.9),
    lighting=Lighting(azimuth=-42.0, elevation=36.0, distance_m=2.6, strength=0.9),
    surroundings=Surroundings(wall=Wall.CANVAS, wall_colour=(0.19, 0.22, 0.25)),
    focal_length=FocalLength.EXIF,
    seed=1,
)

_CASES = (
    DEMO,
    Case(
        name="woman_slim_turned",
        person="woman_slim",
        stance=TURNED,
        view=View(distance_m=2.7, aim_height_m=0.83, height_m=1.45),
        lighting=Lighting(azimuth=-55.0, elevation=30.0, distance_m=2.6, strength=0.95),
        surroundings=Surroundings(
            wall=Wall.PLASTER,
            floor=Floor.WOOD,
            wall_colour=(0.38, 0.42, 0.38),
            floor_colour=(0.22, 0.12, 0.065),
        ),
        look=Look(
            skin=(0.44, 0.25, 0.16),
            hair=Hair.TIED,
            hair_colour=(0.02, 0.014, 0.01),
            clothes_colour=(0.03, 0.1, 0.09),
        ),
        focal_length=FocalLength.GIVEN,
        seed=2,
    ),
    Case(
        name="woman_middling_standing",
        person="woman_middling",
        stance=UPRIGHT,
        view=View(distance_m=2.8, aim_height_m=0.86, height_m=1.3),
        lighting=Lighting(azimuth=40.0, elevation=35.0, distance_m=2.7, strength=0.85),
        surroundings=Surroundings(
            wall=Wall.BRICK, wall_colour=(0.3, 0.13, 0.085), floor_colour=(0.25, 0.25, 0.25)
        ),
        look=Look(
            skin=(0.5, 0.31, 0.21),
            hair=Hair.TIED,
            hair_colour=(0.09, 0.05, 0.025),
            clothes_colour=(0.45, 0.42, 0.4),
        ),
        focal_length=FocalLength.GIVEN,
        seed=3,
    ),
    Case(
        name="woman_heavy_arm_across",
        person="woman_heavy",
        stance=ARM_ACROSS,
        view=View(distance_m=3.1, aim_height_m=0.83, height_m=1.4, equivalent_mm=58),
        lighting=Lighting(azimuth=-35.0, elevation=42.0, distance_m=2.8, strength=0.85),
        surroundings=Surroundings(
            wall=Wall.BOARDS,
            floor=Floor.CARPET,
            wall_colour=(0.2, 0.26, 0.3),
            floor_colour=(0.2, 0.07, 0.06),
        ),
        look=Look(
            skin=(0.62, 0.41, 0.31),
            hair=Hair.SHORT,
            hair_colour=(0.16, 0.085, 0.035),
            clothes_colour=(0.05, 0.02, 0.04),
        ),
        focal_length=FocalLength.EXIF,
        seed=4,
    ),
    Case(
        name="man_thin_hand_raised",
        person="man_thin",
        stance=HAND_RAISED,
        view=View(distance_m=3.1, aim_height_m=0.94, height_m=1.5),
        lighting=Lighting(azimuth=-30.0, elevation=30.0, distance_m=2.8, strength=0.85),
        surroundings=Surroundings(
            wall=Wall.CANVAS,
            floor=Floor.WOOD,
            wall_colour=(0.22, 0.19, 0.15),
            floor_colour=(0.16, 0.085, 0.05),
        ),
        look=Look(
            skin=(0.6, 0.38, 0.28), hair_colour=(0.2, 0.12, 0.05), clothes_colour=(0.3, 0.05, 0.04)
        ),
        focal_length=FocalLength.GIVEN,
        seed=5,
    ),
    Case(
        name="man_middling_standing",
        person="man_middling",
        stance=UPRIGHT,
        view=View(distance_m=2.95, aim_height_m=0.9, height_m=1.2),
        lighting=Lighting(azimuth=-50.0, elevation=28.0, distance_m=2.5, strength=0.9),
        surroundings=Surroundings(wall_colour=(0.45, 0.43, 0.38)),
        look=Look(
            skin=(0.3, 0.165, 0.1),
            hair=Hair.SHAVED,
            hair_colour=(0.015, 0.012, 0.01),
            clothes_colour=(0.25, 0.26, 0.28),
        ),
        focal_length=FocalLength.MISSING,
        seed=6,
    ),
    Case(
        name="man_heavy_striding",
        person="man_heavy",
        stance=STRIDING,
        view=View(distance_m=2.6, equivalent_mm=42, aim_height_m=0.9, height_m=1.4),
        lighting=Lighting(azimuth=35.0, elevation=38.0, distance_m=2.7, strength=0.9),
        surroundings=Surroundings(
            wall=Wall.PLASTER,
            floor=Floor.WOOD,
            wall_colour=(0.3, 0.34, 0.42),
            floor_colour=(0.3, 0.2, 0.12),
        ),
        look=Look(skin=(0.54, 0.33, 0.23), clothes_colour=(0.025, 0.025, 0.03)),
        focal_length=FocalLength.GIVEN,
        seed=7,
    ),
)

CASES: Mapping[str, Case] = {case.name: case for case in _CASES}
