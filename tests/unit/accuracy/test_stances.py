import numpy as np
import pytest

from fitter.body.model import global_rotations
from fitter.training.articulation.parts import PART_PARENT, part_index
from fitter.vocabulary.choices import Gender
from tests.accuracy.landmark_points import packaged_model
from tests.accuracy.scene import Arm, Leg, Stance
from tests.accuracy.stances import pose_of, standing_on_both_feet


@pytest.fixture(scope="module")
def joints() -> np.ndarray:
    from fitter.body.model import regress

    model = packaged_model(Gender.MALE)
    return regress(model.joint_regressor, model.mean_vertices)


def _direction(pose, joints, near, far):
    rotation = global_rotations(pose, PART_PARENT)[part_index(near)]
    bone = rotation @ (joints[part_index(far)] - joints[part_index(near)])
    return bone / np.linalg.norm(bone)


@pytest.mark.parametrize("side", ["left", "right"])
def test_an_arm_of_no_angles_hangs_straight_down(joints, side):
    hanging = Arm(raised=0.0, bend=0.0)
    pose = pose_of(Stance(left_arm=hanging, right_arm=hanging), joints)
    for near, far in (("upper_arm", "forearm"), ("forearm", "hand")):
        direction = _direction(pose, joints, f"{side}_{near}", f"{side}_{far}")
        np.testing.assert_allclose(direction, [0.0, -1.0, 0.0], atol=1e-9)


@pytest.mark.parametrize("turn", [-60.0, 0.0, 45.0])
def test_an_elbow_bends_by_its_angle_however_the_arm_is_turned(joints, turn):
    pose = pose_of(Stance(left_arm=Arm(raised=30.0, turn=turn, bend=70.0)), joints)
    upper = _direction(pose, joints, "left_upper_arm", "left_forearm")
    lower = _direction(pose, joints, "left_forearm", "left_hand")
    assert np.degrees(np.arccos(upper @ lower)) == pytest.approx(70.0, abs=1e-6)


def test_a_knee_bends_backward_by_its_angle(joints):
    pose = pose_of(Stance(left_leg=Leg(raised=0.0, turn=0.0, bend=40.0)), joints)
    upper = _direction(pose, joints, "left_thigh", "left_shin")
    lower = _direction(pose, joints, "left_shin", "left_foot")
    # About the sideways axis, which is square to the thigh but for its slight slope at rest.
    assert np.degrees(np.arccos(upper @ lower)) == pytest.approx(40.0, abs=0.5)
    assert lower[2] < 0.0


def test_a_tilted_pelvis_leaves_the_legs_where_they_were_aimed(joints):
    level = pose_of(Stance(), joints)
    tilted = pose_of(Stance(pelvis=(3.0, 0.0, -6.0)), joints)
    for near, far in (("thigh", "shin"), ("shin", "foot")):
        names = f"left_{near}", f"left_{far}"
        np.testing.assert_allclose(
            _direction(tilted, joints, *names), _direction(level, joints, *names), atol=1e-9
        )


def test_facing_turns_everything_about_the_vertical(joints):
    ahead, turned = (pose_of(Stance(facing=angle), joints) for angle in (0.0, 90.0))
    arm = "left_upper_arm", "left_forearm"
    x, y, z = _direction(ahead, joints, *arm)
    np.testing.assert_allclose(_direction(turned, joints, *arm), [z, y, -x], atol=1e-9)


def test_the_free_knee_bends_until_both_feet_are_equally_low(joints):
    def foot_height(pose, side):
        heights = [
            _direction(pose, joints, f"{side}_{near}", f"{side}_{far}")[1] * length
            for near, far, length in (("thigh", "shin", 0.45), ("shin", "foot", 0.42))
        ]
        return sum(heights) - (0.03 if side == "left" else 0.0)

    pose = standing_on_both_feet(Stance(free_leg="left"), joints, foot_height)
    assert foot_height(pose, "left") == pytest.approx(foot_height(pose, "right"), abs=1e-4)
