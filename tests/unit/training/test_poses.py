from itertools import islice

import numpy as np

from fitter.body.model import global_rotations, posed_joints
from fitter.numerics.rotations import rotation_matrices
from fitter.training.articulation.parts import PART_NAMES, PART_PARENT, part_index
from fitter.training.articulation.poses import (
    CANONICAL_ARM_DEGREES,
    EVERY,
    REACHES,
    canonical_pose,
    random_pose,
    relative_pose,
    rotation_between,
    standing_pose,
    taught_poses,
)
from fitter.training.articulation.rig_drives import rest_axis

RNG = np.random.default_rng(21)
JOINTS = RNG.normal(size=(len(PART_NAMES), 3))


def posed(pose):
    return posed_joints(JOINTS, global_rotations(pose, PART_PARENT), PART_PARENT)


def direction(joints, first, second):
    vector = joints[part_index(second)] - joints[part_index(first)]
    return vector / np.linalg.norm(vector)


def test_limbs_are_straight_in_the_standing_and_canonical_pose():
    for pose in (standing_pose(JOINTS), canonical_pose(JOINTS)):
        joints = posed(pose)
        for side in ("left", "right"):
            for limb in (("upper_arm", "forearm", "hand"), ("thigh", "shin", "foot")):
                first, second, third = (f"{side}_{name}" for name in limb)
                np.testing.assert_allclose(
                    direction(joints, first, second), direction(joints, second, third), atol=1e-9
                )


def test_canonical_arms_hang_away_from_the_trunk_to_their_own_side():
    joints = posed(canonical_pose(JOINTS))
    for side, sign in (("left", 1.0), ("right", -1.0)):
        arm = direction(joints, f"{side}_upper_arm", f"{side}_forearm")
        angle = np.radians(CANONICAL_ARM_DEGREES)
        np.testing.assert_allclose(arm, [sign * np.sin(angle), -np.cos(angle), 0.0], atol=1e-9)


def test_soles_and_trunk_stay_as_they_are_at_rest():
    rotations = global_rotations(standing_pose(JOINTS), PART_PARENT)
    for name in ("pelvis", "chest", "head", "left_foot", "right_foot"):
        np.testing.assert_allclose(rotations[part_index(name)], np.eye(3), atol=1e-9)


def test_relative_poses_chain_back_to_the_rotations_they_came_from():
    turned = rotation_matrices(RNG.normal(size=(len(PART_NAMES), 3)))
    np.testing.assert_allclose(
        global_rotations(relative_pose(turned), PART_PARENT), turned, atol=1e-9
    )


def test_the_rotation_between_two_directions_takes_one_to_the_other():
    for first, second in RNG.normal(size=(50, 2, 3)):
        turned = rotation_between(first, second) @ (first / np.linalg.norm(first))
        np.testing.assert_allclose(turned, second / np.linalg.norm(second), atol=1e-12)


def test_random_poses_reach_raised_arms_and_deep_bends():
    poses = np.stack([random_pose(np.random.default_rng(k)) for k in range(300)])
    assert np.isfinite(poses).all()
    largest = np.degrees(np.linalg.norm(poses, axis=2)).max(axis=0)
    wanted = {"left_upper_arm": 110, "left_forearm": 85, "left_thigh": 80, "right_shin": 110}
    for name, degrees in wanted.items():
        assert largest[part_index(name)] > degrees
    assert largest[0] == 0.0


def test_one_seed_gives_one_pose():
    first, second = (random_pose(np.random.default_rng(4)) for _ in range(2))
    np.testing.assert_array_equal(first, second)


ROUND = EVERY * len(REACHES)


def poses(count: int) -> np.ndarray:
    return np.stack(list(islice(taught_poses(np.random.default_rng(5)), count)))


def elevations(of: np.ndarray) -> np.ndarray:
    turns = rotation_matrices(of[:, part_index("left_upper_arm")])
    return np.degrees(np.arccos(-(turns @ rest_axis("left_upper_arm"))[:, 1]))


def test_every_class_of_reaches_has_its_turn():
    found = elevations(poses(3 * ROUND)[::EVERY])
    for number, reach in enumerate(REACHES):
        of_class = found[number :: len(REACHES)]
        assert reach.elevation[0] <= of_class.min() <= of_class.max() <= reach.elevation[1]


def test_many_poses_have_arms_overhead_and_most_are_any():
    found = elevations(poses(50 * ROUND))
    assert 0.2 < np.mean(found > 100.0) < 0.6
    assert np.mean(found < 60.0) > 0.25


def test_one_seed_gives_the_same_poses():
    np.testing.assert_array_equal(poses(5), poses(5))
