"""Parts of a mesh, joints as weighted sums of its vertices, and the poses that are taught."""

from itertools import islice

import numpy as np
import trimesh

from fitter.body.model import global_rotations, posed_joints
from fitter.numerics.rotations import rotation_matrices
from fitter.training.articulation.joints import (
    fit_joint_regressor,
    joint_errors_mm,
    joint_rows_of_bones,
    regressed_joints,
)
from fitter.training.articulation.parts import (
    PART_NAMES,
    PART_PARENT,
    cut_into_parts,
    mirrored_part,
    part_index,
)
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

SPHERE = trimesh.creation.icosphere(subdivisions=2)
TRIANGLES = np.asarray(SPHERE.faces)
VERTICES = np.asarray(SPHERE.vertices)


def soft_halves():
    upper = 1.0 / (1.0 + np.exp(-8.0 * VERTICES[:, 2]))
    noise = np.full((len(VERTICES), 3), 1e-3)
    weights = np.concatenate([upper[:, None], 1.0 - upper[:, None], noise], axis=1)
    return weights / weights.sum(axis=1, keepdims=True)


def test_a_triangle_belongs_to_the_part_its_corners_follow_most():
    parts = cut_into_parts(TRIANGLES, soft_halves())
    centres = VERTICES[TRIANGLES].mean(axis=1)
    clear = np.abs(centres[:, 2]) > 0.05
    np.testing.assert_array_equal(
        parts.part_of_triangle[clear], np.where(centres[clear, 2] > 0, 0, 1)
    )


def test_incidences_list_the_vertices_each_part_touches_once():
    parts = cut_into_parts(TRIANGLES, soft_halves())
    for part in range(5):
        start, stop = parts.incidence_pointers[part : part + 2]
        expected = np.unique(TRIANGLES[parts.part_of_triangle == part])
        np.testing.assert_array_equal(parts.incidence_vertices[start:stop], expected)


def test_kept_skinning_weights_are_the_largest_and_sum_to_one():
    weights = soft_halves()
    parts = cut_into_parts(TRIANGLES, weights)
    np.testing.assert_allclose(parts.skinning_weights.sum(axis=1), 1.0)
    np.testing.assert_array_equal(parts.skinning_parts[:, 0], np.argmax(weights, axis=1))
    assert (np.diff(parts.skinning_weights, axis=1) <= 0).all()


MIRROR_JOINT = np.array([part_index(mirrored_part(name)) for name in PART_NAMES])


def symmetric_bodies(subjects=60, half=150):
    """Clouds with exact mirror pairs, and joints that are convex sums of nearby vertices."""
    draws = np.random.default_rng(108)
    left = draws.uniform([0.02, -0.3, -0.3], [0.6, 0.3, 0.3], size=(half, 3))
    flip = np.array([-1.0, 1.0, 1.0])
    mean = np.concatenate([left, left * flip])
    mirror = np.concatenate([np.arange(half) + half, np.arange(half)])
    moves = draws.normal(scale=0.05, size=(subjects, half, 3))
    meshes = mean + np.concatenate([moves, moves * flip], axis=1)
    planted = np.zeros((len(PART_NAMES), 2 * half))
    for part, name in enumerate(PART_NAMES):
        if name.startswith("right"):
            continue
        anchor = left[draws.integers(half)]
        near = np.argsort(np.linalg.norm(mean - anchor, axis=1))[:12]
        planted[part, near] += 1.0 / 12.0
        if mirrored_part(name) == name:
            planted[part] = 0.5 * (planted[part] + planted[part, mirror])
    for part, name in enumerate(PART_NAMES):
        if name.startswith("right"):
            planted[part] = planted[MIRROR_JOINT[part], mirror]
    return meshes, np.einsum("pm,smc->spc", planted, meshes), mirror


def test_planted_joints_are_found_on_bodies_not_trained_on():
    meshes, joints, mirror = symmetric_bodies()
    regressor = fit_joint_regressor(meshes[:40], joints[:40], mirror, MIRROR_JOINT)
    sided = [part for part, name in enumerate(PART_NAMES) if "_" in name]
    assert joint_errors_mm(regressor, meshes[40:], joints[40:])[sided].max() < 10.0


def test_weights_are_positive_and_sum_to_one():
    meshes, joints, mirror = symmetric_bodies()
    regressor = fit_joint_regressor(meshes, joints, mirror, MIRROR_JOINT)
    assert (regressor.weights > 0).all()
    sums = np.add.reduceat(regressor.weights, regressor.pointers[:-1])
    np.testing.assert_allclose(sums, 1.0)


def test_a_mirrored_body_has_mirrored_joints():
    draws = np.random.default_rng(9)
    meshes, joints, mirror = symmetric_bodies()
    regressor = fit_joint_regressor(meshes, joints, mirror, MIRROR_JOINT)
    body = draws.normal(size=meshes[0].shape)
    flip = np.array([-1.0, 1.0, 1.0])
    reflected = np.empty_like(body)
    reflected[mirror] = body * flip
    found = regressed_joints(regressor, np.stack([body, reflected]))
    np.testing.assert_allclose(found[1, MIRROR_JOINT], found[0] * flip, atol=1e-12)


def test_every_joint_is_a_mean_of_bone_centres():
    bones = ("upperarm01", "lowerarm01", "wrist", "upperleg01", "lowerleg01", "foot")
    names = tuple(f"{bone}.{side}" for bone in bones for side in "LR")
    names += ("spine05", "spine04", "spine03", "spine02", "spine01")
    names += ("neck01", "neck02", "neck03", "head")
    np.testing.assert_allclose(joint_rows_of_bones(names).sum(axis=1), 1.0)


TURNS = np.random.default_rng(21)
JOINTS = TURNS.normal(size=(len(PART_NAMES), 3))


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
    draws = np.random.default_rng(22)
    turned = rotation_matrices(draws.normal(size=(len(PART_NAMES), 3)))
    np.testing.assert_allclose(
        global_rotations(relative_pose(turned), PART_PARENT), turned, atol=1e-9
    )


def test_the_rotation_between_two_directions_takes_one_to_the_other():
    draws = np.random.default_rng(22)
    for first, second in draws.normal(size=(50, 2, 3)):
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
