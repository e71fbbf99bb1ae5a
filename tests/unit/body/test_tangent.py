"""The linear-blend tangent against the exact body."""

import numpy as np
import pytest

from fitter.body.scape import ScapeEvaluator, half_turns, increment, pose_derivative, pose_features
from fitter.body.tangent import linearise, tangent_model
from fitter.numerics.rotations import compose, rotation_matrices
from fitter.parameters import BodyParameters
from tests.unit.body.plain_tangent import attached_vertices, point_jacobian
from tests.unit.body.synthetic_model import bar_model


def test_the_tangent_is_exact_for_root_motion_and_close_for_joints_and_shape():
    model = bar_model()
    evaluator = ScapeEvaluator(model)
    tangent = tangent_model(model)
    rng = np.random.default_rng(0)
    parameters = BodyParameters(
        pose=0.2 * rng.standard_normal((3, 3)),
        translation=np.array([0.1, -0.2, 3.0]),
        shape=rng.standard_normal(2),
    )
    chosen = np.array([3, 17, 40, 70, 100, 105])
    jacobian = point_jacobian(
        linearise(tangent, parameters),
        attached_vertices(tangent, chosen),
        evaluator.vertices(parameters)[chosen],
    )
    step = 1e-5
    exact = np.empty_like(jacobian)
    for column in range(jacobian.shape[2]):
        delta = np.zeros(jacobian.shape[2])
        delta[column] = step
        sides = []
        for sign in (1, -1):
            moved = increment(
                parameters,
                pose=sign * delta[:9].reshape(3, 3),
                translation=sign * delta[9:12],
                shape=sign * delta[12:],
            )
            sides.append(evaluator.vertices(moved)[chosen])
        exact[:, :, column] = (sides[0] - sides[1]) / (2 * step)
    np.testing.assert_allclose(jacobian[:, :, :3], exact[:, :, :3], atol=1e-6)
    np.testing.assert_allclose(jacobian[:, :, 9:12], exact[:, :, 9:12], atol=1e-6)
    relative = np.linalg.norm(jacobian - exact) / np.linalg.norm(exact)
    assert relative < 0.15


JOINTS = np.array([[1, -1, -1], [0, 5, 2], [2, 4, -1]])
"""Three joints: 3, 4 and 5 stand for half their turns."""


def random_pose(seed: int, scale: float = 0.8) -> np.ndarray:
    return scale * np.random.default_rng(seed).standard_normal((3, 3))


def test_a_body_at_rest_has_no_features():
    assert not pose_features(np.zeros((3, 3)), JOINTS).any()


def test_features_are_rotations_less_the_identity_in_the_order_of_the_table():
    pose = random_pose(0)
    found = pose_features(pose, JOINTS).reshape(3, 3, 3, 3)
    whole, half = rotation_matrices(pose), rotation_matrices(0.5 * pose)
    np.testing.assert_allclose(found[1, 0], whole[0] - np.eye(3), atol=1e-12)
    np.testing.assert_allclose(found[1, 1], half[2] - np.eye(3), atol=1e-12)
    np.testing.assert_allclose(found[2, 1], half[1] - np.eye(3), atol=1e-12)
    assert not found[0, 1:].any()


@pytest.mark.parametrize("angle", [0.0, 1e-12, 0.4, 3.1, 3.3, 6.2, 6.4, 9.0])
def test_half_a_turn_twice_is_the_turn_by_the_short_way(angle):
    axis = np.array([[0.6, 0.0, -0.8]])
    half = half_turns(angle * axis)
    twice = rotation_matrices(half)[0] @ rotation_matrices(half)[0]
    np.testing.assert_allclose(twice, rotation_matrices(angle * axis)[0], atol=1e-12)
    assert np.linalg.norm(half) <= np.pi / 2 + 1e-12


def test_vectors_of_one_rotation_have_the_same_features():
    pose = random_pose(1)
    angles = np.linalg.norm(pose, axis=1, keepdims=True)
    longer = pose * (1.0 + 2.0 * np.pi / angles)
    np.testing.assert_allclose(
        pose_features(longer, JOINTS), pose_features(pose, JOINTS), atol=1e-12
    )


@pytest.mark.parametrize("scale", [0.0, 0.5, 1.5])
def test_the_derivative_agrees_with_finite_differences(scale):
    pose, step = random_pose(2, scale), 1e-6
    weights = np.random.default_rng(3).standard_normal((3, 27))
    found = pose_derivative(pose, JOINTS, weights)
    for joint, axis in np.ndindex(3, 3):
        ahead = np.zeros((3, 3))
        ahead[joint, axis] = step
        slope = (
            (pose_features(compose(ahead, pose), JOINTS) * weights).sum()
            - (pose_features(compose(-ahead, pose), JOINTS) * weights).sum()
        ) / (2 * step)
        assert found[joint, axis] == pytest.approx(slope, abs=1e-7, rel=1e-6)
