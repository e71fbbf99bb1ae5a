"""Named stances of three kinds: standing, hiding parts of themselves, turned or striding."""

from collections.abc import Mapping
from enum import StrEnum

from tests.accuracy.scene import Arm, Leg, Stance


class Kind(StrEnum):
    """What a picture asks of the fit; ``OCCLUDED`` as in the paper's Fig. 4."""

    STANDING = "standing"
    OCCLUDED = "occluded"
    TURNED = "turned"


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

ASTRIDE = Stance(
    facing=9.0,
    spine=(-2.0, 2.0, 0.0),
    head=(3.0, -7.0, 0.0),
    left_arm=Arm(raised=36.0, forward=12.0, bend=24.0),
    right_arm=Arm(raised=31.0, forward=-14.0, bend=34.0),
    left_leg=Leg(raised=13.0, bend=2.0, turn=8.0, toe_out=14.0),
    right_leg=Leg(raised=13.0, bend=2.0, turn=8.0, toe_out=14.0),
    free_leg="left",
)
"""Feet well apart, arms well away."""

AT_EASE = Stance(
    facing=-14.0,
    pelvis=(0.0, 0.0, 4.0),
    spine=(0.0, 3.0, -3.0),
    chest=(0.0, 4.0, -2.0),
    head=(2.0, 9.0, 2.0),
    left_arm=Arm(raised=17.0, forward=20.0, bend=14.0),
    right_arm=Arm(raised=20.0, forward=-8.0, bend=22.0),
    left_leg=Leg(raised=2.0, bend=1.0),
    right_leg=Leg(raised=11.0, forward=35.0, turn=14.0, toe_out=20.0),
    free_leg="right",
)
"""Weight on the left leg, arms hanging."""

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

LEGS_CROSSED = Stance(
    facing=-10.0,
    pelvis=(0.0, 0.0, -4.0),
    spine=(-1.0, 0.0, 3.0),
    chest=(0.0, 3.0, 2.0),
    head=(3.0, 6.0, -2.0),
    left_arm=Arm(raised=30.0, forward=70.0, turn=-28.0, bend=38.0),
    right_arm=Arm(raised=22.0, forward=-15.0, bend=18.0),
    left_leg=Leg(raised=15.0, forward=118.0, turn=6.0, toe_out=8.0),
    right_leg=Leg(raised=2.0, forward=180.0, turn=6.0, bend=2.0),
    free_leg="left",
)
"""The left shin before the right one, the left hand before the trunk."""

HANDS_BEFORE = Stance(
    facing=8.0,
    spine=(2.0, -2.0, 0.0),
    neck=(4.0, 0.0, 0.0),
    head=(5.0, -6.0, -3.0),
    left_arm=Arm(raised=34.0, forward=50.0, turn=-34.0, bend=62.0),
    right_arm=Arm(raised=36.0, forward=55.0, turn=-30.0, bend=44.0),
    left_leg=Leg(raised=7.0, forward=30.0, bend=6.0),
    right_leg=Leg(raised=5.0, bend=2.0),
    free_leg="left",
)
"""One hand before the belly, the other before the thighs."""

THREE_QUARTERS = Stance(
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

NEARLY_PROFILE = Stance(
    facing=62.0,
    spine=(-2.0, -5.0, 0.0),
    chest=(0.0, -8.0, 0.0),
    head=(2.0, -16.0, 0.0),
    left_arm=Arm(raised=24.0, forward=-72.0, bend=20.0),
    right_arm=Arm(raised=28.0, forward=72.0, bend=40.0),
    left_leg=Leg(raised=8.0, forward=-70.0, bend=5.0, heel_up=3.0),
    right_leg=Leg(raised=12.0, forward=80.0, bend=4.0, toe_out=8.0),
    free_leg="left",
)
"""Seen from the right, the feet one before the other."""

STEPPING = Stance(
    facing=18.0,
    pelvis=(0.0, 0.0, 3.0),
    spine=(4.0, -4.0, -2.0),
    chest=(1.0, -5.0, 0.0),
    head=(0.0, -8.0, 0.0),
    left_arm=Arm(raised=28.0, forward=62.0, bend=48.0),
    right_arm=Arm(raised=25.0, forward=-45.0, bend=26.0),
    left_leg=Leg(raised=13.0, forward=-75.0, bend=12.0, heel_up=10.0),
    right_leg=Leg(raised=18.0, forward=78.0, bend=8.0, toe_out=6.0),
    free_leg="left",
)
"""A step toward the camera."""

STANCES: Mapping[Kind, tuple[Stance, ...]] = {
    Kind.STANDING: (UPRIGHT, AT_EASE, CONTRAPPOSTO, ASTRIDE),
    Kind.OCCLUDED: (ARM_ACROSS, LEGS_CROSSED, HAND_RAISED, HANDS_BEFORE),
    Kind.TURNED: (THREE_QUARTERS, STRIDING, NEARLY_PROFILE, STEPPING),
}
