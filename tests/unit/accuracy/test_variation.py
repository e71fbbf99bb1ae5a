from dataclasses import fields

import numpy as np
import pytest

from tests.accuracy.stance_kinds import ARM_ACROSS, STANCES
from tests.accuracy.stances import pose_of
from tests.accuracy.variation import BEND_SHARE, JITTER_DEGREES, mirrored, opened, unsteady

EVERY = [stance for stances in STANCES.values() for stance in stances]


@pytest.mark.parametrize("stance", EVERY)
def test_a_stance_mirrored_twice_is_itself(stance):
    assert mirrored(mirrored(stance)) == stance
    assert mirrored(stance) != stance


def test_a_mirrored_stance_is_the_mirrored_pose():
    sides = np.array([1.0, -1.0, -1.0])
    joints = np.random.default_rng(0).normal(size=(17, 3))
    from fitter.training.articulation.parts import PART_NAMES

    other = [
        PART_NAMES.index(name.replace("left", "*").replace("right", "left").replace("*", "right"))
        for name in PART_NAMES
    ]
    joints = 0.5 * (joints + joints[other] * [-1.0, 1.0, 1.0])
    pose, reflected = (pose_of(stance, joints) for stance in (ARM_ACROSS, mirrored(ARM_ACROSS)))
    np.testing.assert_allclose(reflected, pose[other] * sides, atol=1e-9)


def test_an_opened_stance_raises_limbs_and_turns_inward_arms_out_but_never_outward():
    wide = opened(ARM_ACROSS, arms=5.0, legs=2.0)
    assert wide.left_arm.raised == ARM_ACROSS.left_arm.raised + 5.0
    assert ARM_ACROSS.left_arm.turn < wide.left_arm.turn < 0.0
    assert wide.right_arm.turn == ARM_ACROSS.right_arm.turn
    assert wide.right_leg.raised == ARM_ACROSS.right_leg.raised + 2.0
    assert opened(ARM_ACROSS, arms=90.0, legs=0.0).left_arm.turn == 0.0


@pytest.mark.parametrize("stance", EVERY)
def test_an_unsteady_stance_differs_by_a_few_degrees_and_keeps_heels_and_fists(stance):
    shaken = unsteady(stance, np.random.default_rng(1))
    for name in ("left_arm", "right_arm", "left_leg", "right_leg"):
        limb, was = getattr(shaken, name), getattr(stance, name)
        for each in fields(limb):
            change = abs(getattr(limb, each.name) - getattr(was, each.name))
            assert (
                change
                <= 1.5 * (BEND_SHARE * was.bend if each.name == "bend" else JITTER_DEGREES) + 0.1
            )
            if each.name in ("heel_up", "curl"):
                assert change == 0.0
    assert shaken != stance
