"""Where limbs and trunk point in the extreme poses."""

import numpy as np
import pytest

from fitter.body.skeleton import global_rotations, posed_joints
from fitter.training.articulation.extreme_poses import (
    ELBOW_BENT_DEGREES,
    HIP_ABDUCTED_DEGREES,
    HIP_FLEXED_DEGREES,
    KNEE_BENT_DEGREES,
    SHOULDER_RAISED_DEGREES,
    extreme_poses,
)
from fitter.training.articulation.named_poses import canonical_pose
from fitter.training.articulation.part_tree import PART_NAMES, PART_PARENT, part_index
from tests.unit.pose_init.stick_figure import stick_figure

JOINTS = stick_figure().rest_joints
POSES = extreme_poses(JOINTS)
TRUNK = {"spine bent", "spine arched", "spine leaning", "spine twisted"}


def bone(name: str, first: str, second: str) -> np.ndarray:
    joints = posed_joints(JOINTS, global_rotations(POSES[name], PART_PARENT), PART_PARENT)
    way = joints[part_index(second)] - joints[part_index(first)]
    return way / np.linalg.norm(way)


def angle(one: np.ndarray, other: np.ndarray) -> float:
    return float(np.degrees(np.arccos(np.clip(one @ other, -1.0, 1.0))))


@pytest.mark.parametrize(
    ("name", "limb", "degrees", "toward"),
    [
        ("shoulder raised", ("left_upper_arm", "left_forearm"), SHOULDER_RAISED_DEGREES, 0),
        ("hip flexed", ("left_thigh", "left_shin"), HIP_FLEXED_DEGREES, 2),
        ("hip abducted", ("left_thigh", "left_shin"), HIP_ABDUCTED_DEGREES, 0),
    ],
)
def test_limbs_are_raised_by_what_their_names_say(name, limb, degrees, toward):
    found = bone(name, *limb)
    assert angle(found, np.array([0.0, -1.0, 0.0])) == pytest.approx(degrees, abs=1e-6)
    assert found[toward] > 0.1


@pytest.mark.parametrize(
    ("name", "upper", "lower", "degrees"),
    [
        ("elbow bent", "upper_arm forearm", "forearm hand", ELBOW_BENT_DEGREES),
        ("knee bent", "thigh shin", "shin foot", KNEE_BENT_DEGREES),
        ("hip flexed", "thigh shin", "shin foot", 90.0),
        ("shoulder raised", "upper_arm forearm", "forearm hand", 0.0),
    ],
)
def test_hinges_bend_by_what_their_names_say(name, upper, lower, degrees):
    one, other = (bone(name, *(f"left_{part}" for part in pair.split())) for pair in (upper, lower))
    # The knee's hinge lies across the body, a little off square to a leg that leans outward.
    assert angle(one, other) == pytest.approx(degrees, abs=1.0)


def test_knees_bend_backward_and_elbows_forward():
    assert bone("knee bent", "left_shin", "left_foot")[2] < -0.5
    assert bone("elbow bent", "left_forearm", "left_hand")[2] > 0.2


@pytest.mark.parametrize("name", POSES)
def test_all_but_the_left_limb_or_the_trunk_is_canonical(name):
    turned = np.linalg.norm(POSES[name] - canonical_pose(JOINTS), axis=1) > 1e-9
    changed = {PART_NAMES[part] for part in np.flatnonzero(turned)}
    assert changed
    if name in TRUNK:
        assert changed == {"spine", "chest"}
    else:
        assert all(part.startswith("left_") for part in changed)


def test_the_trunk_bends_forward_back_aside_and_round():
    head = {name: bone(name, "pelvis", "head") for name in TRUNK}
    assert head["spine bent"][2] > 0.4
    assert head["spine arched"][2] < -0.1
    assert abs(head["spine leaning"][0]) > 0.3
    shoulders = bone("spine twisted", "right_upper_arm", "left_upper_arm")
    assert angle(shoulders, np.array([1.0, 0.0, 0.0])) == pytest.approx(45.0, abs=1.0)
