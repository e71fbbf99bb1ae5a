"""Landmarks on a skeleton."""

import numpy as np
import pytest

from fitter.body.model import regress
from fitter.body.scape import CAMERA_AXES
from fitter.numerics.rotations import rotation_matrices
from fitter.pose_init._landmark_kernels import pose_rig
from fitter.pose_init.landmark_rig import (
    landmark_points,
    landmark_rig,
    rig_arrays,
)
from fitter.pose_init.limbs import limb_lengths_m, point_at_rest
from tests.unit.body.synthetic_model import bar_model
from tests.unit.pose_init.stick_figure import mirrored_pose, stick_figure

RIG = stick_figure()


def test_at_rest_landmarks_stand_where_the_rest_body_has_them():
    place = np.array([0.1, -0.2, 3.0])
    points = landmark_points(RIG, np.zeros((17, 3)), place)
    expected = (RIG.rest_landmarks - RIG.rest_joints[0]) * CAMERA_AXES + place
    np.testing.assert_allclose(points, expected, atol=1e-12)


def test_bones_keep_their_length_in_every_pose():
    rng = np.random.default_rng(6)
    local = rotation_matrices(0.8 * rng.standard_normal((20 * 17, 3))).reshape(20, 17, 3, 3)
    joints = np.stack([pose_rig(rig_arrays(RIG), each, np.zeros(3)).joints for each in local])
    for part, parent in enumerate(RIG.part_parent[1:], start=1):
        length = np.linalg.norm(RIG.rest_joints[part] - RIG.rest_joints[parent])
        measured = np.linalg.norm(joints[:, part] - joints[:, parent], axis=1)
        np.testing.assert_allclose(measured, length, atol=1e-12)


def test_a_batch_of_poses_has_the_plain_landmarks():
    rng = np.random.default_rng(7)
    poses, places = rng.standard_normal((2, 4, 17, 3)), rng.standard_normal((2, 4, 3))
    np.testing.assert_allclose(
        landmark_points(RIG, poses, places),
        landmark_points(RIG, poses, places),
        atol=1e-12,
    )


def test_the_mirror_image_of_a_pose_has_the_mirrored_landmarks():
    rng = np.random.default_rng(8)
    pose = 0.6 * rng.standard_normal((17, 3))
    points = landmark_points(RIG, pose, np.zeros(3))
    mirrored = landmark_points(RIG, mirrored_pose(pose), np.zeros(3))
    for name in RIG.landmark_names:
        partner = name.replace("left_", "#").replace("right_", "left_").replace("#", "right_")
        np.testing.assert_allclose(
            mirrored[RIG.landmark_names.index(partner)],
            points[RIG.landmark_names.index(name)] * [-1.0, 1.0, 1.0],
            atol=1e-12,
        )


def test_a_model_gives_landmarks_regressed_from_its_vertices():
    model = bar_model()
    shape = np.array([0.5, -1.0])
    rig = landmark_rig(model, shape)
    vertices = model.mean_vertices + np.tensordot(shape, model.shape_basis, axes=1)
    expected = regress(model.landmarks, vertices)
    np.testing.assert_allclose(rig.rest_landmarks, expected)
    np.testing.assert_allclose(rig.weights.sum(axis=1), 1.0)
    root = regress(model.joint_regressor, vertices)[0]
    resting = landmark_points(rig, np.zeros((3, 3)), np.zeros(3))
    np.testing.assert_allclose(resting, (expected - root) * CAMERA_AXES, atol=1e-12)


def test_limb_lengths_follow_the_landmarks():
    lengths = limb_lengths_m(RIG)
    knee, ankle = RIG.landmark("left_knee"), RIG.landmark("left_ankle")
    assert lengths["left_shin"] == pytest.approx(np.linalg.norm(knee - ankle))
    assert lengths["left_shin"] == pytest.approx(lengths["right_shin"])
    assert point_at_rest(RIG, "pelvis_middle")[0] == pytest.approx(0.0)
