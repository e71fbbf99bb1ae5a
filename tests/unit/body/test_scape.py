"""The run-time evaluation against closed forms, a plain solve and finite differences."""

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

from fitter.body.model import global_rotations, posed_joints
from fitter.body.scape import CAMERA_AXES, ScapeEvaluator, increment
from fitter.body.shape_space import height_of_shape, rest_vertices, shape_for_height
from fitter.numerics.meshes import gradient_operator
from fitter.numerics.rotations import rotation_matrices
from fitter.parameters import BodyParameters
from tests.unit.body.synthetic_model import bar_model


@pytest.fixture(scope="module")
def evaluator() -> ScapeEvaluator:
    return ScapeEvaluator(bar_model())


def random_parameters(rng: np.random.Generator, scale: float = 0.5) -> BodyParameters:
    return BodyParameters(
        pose=scale * rng.standard_normal((3, 3)),
        translation=rng.standard_normal(3) + [0, 0, 3],
        shape=rng.standard_normal(2),
    )


def plain_body_frame_vertices(model, parameters: BodyParameters) -> np.ndarray:
    """Least squares over triangles' gradients, written as the paper states it."""
    gradient = gradient_operator(model.mean_vertices, model.triangles)
    weights = np.repeat(model.triangle_weights, 2)
    target = gradient @ rest_vertices(model, parameters.shape)
    rotations = global_rotations(parameters.pose, model.part_parent)
    part = np.repeat(model.part_of_triangle, 2)
    right = gradient.T @ (weights[:, None] * np.einsum("tij,tj->ti", rotations[part], target))
    turns = np.concatenate([parameters.pose, 0.5 * parameters.pose])
    difference = rotation_matrices(turns) - np.eye(3)
    for index in range(len(model.part_names)):
        joints = model.pose_feature_joints[index]
        features = np.concatenate(
            [difference[j].ravel() if j >= 0 else np.zeros(9) for j in joints]
        )
        features *= 1.0 + model.pose_feature_strengths[index] @ parameters.shape
        start, stop = model.incidence_pointers[index : index + 2]
        local = model.pose_right_hand_sides[start:stop].astype(float) @ features
        right[model.incidence_vertices[start:stop]] += local @ rotations[index].T
    matrix = (gradient.T @ (gradient * weights[:, None])).tolil()
    matrix[0, :] = 0.0
    matrix[0, 0] = 1.0
    right[0] = 0.0
    vertices = np.stack([spsolve(matrix.tocsr(), right[:, c]) for c in range(3)], axis=1)
    rows = model.joint_regressor
    root = rows.weights[: rows.pointers[1]] @ vertices[rows.indices[: rows.pointers[1]]]
    return vertices - root


def test_the_rest_pose_of_the_mean_shape_is_the_mean_mesh(evaluator):
    zero = BodyParameters(pose=np.zeros((3, 3)), translation=np.zeros(3), shape=np.zeros(2))
    vertices = evaluator.body_frame_vertices(zero)
    moved = vertices - vertices[5] + evaluator.model.mean_vertices[5]
    np.testing.assert_allclose(moved, evaluator.model.mean_vertices, atol=1e-6)


def test_any_shape_at_rest_is_reproduced_exactly_by_its_gradients(evaluator):
    shape = np.array([1.5, -2.0])
    zero = BodyParameters(pose=np.zeros((3, 3)), translation=np.zeros(3), shape=shape)
    vertices = evaluator.body_frame_vertices(zero)
    expected = rest_vertices(evaluator.model, shape)
    np.testing.assert_allclose(vertices - vertices[0], expected - expected[0], atol=1e-6)


def test_the_factored_solve_equals_the_plain_least_squares(evaluator):
    parameters = random_parameters(np.random.default_rng(1))
    np.testing.assert_allclose(
        evaluator.body_frame_vertices(parameters),
        plain_body_frame_vertices(evaluator.model, parameters),
        atol=2e-6,
    )


def test_turning_the_root_turns_the_body_rigidly(evaluator):
    rng = np.random.default_rng(2)
    parameters = random_parameters(rng)
    turned = parameters.pose.copy()
    turned[0] = [0.3, -1.0, 2.0]
    upright = parameters.pose.copy()
    upright[0] = 0.0
    base = BodyParameters(pose=upright, translation=np.zeros(3), shape=parameters.shape)
    moved = BodyParameters(pose=turned, translation=np.zeros(3), shape=parameters.shape)
    rotation = rotation_matrices(turned[:1])[0]
    # The root's own rotation drives no pose feature in this model.
    np.testing.assert_allclose(
        evaluator.body_frame_vertices(moved),
        evaluator.body_frame_vertices(base) @ rotation.T,
        atol=1e-6,
    )


def test_zero_pose_faces_the_camera_upright(evaluator):
    zero = BodyParameters(
        pose=np.zeros((3, 3)), translation=np.array([0.1, 0.2, 3.0]), shape=np.zeros(2)
    )
    camera = evaluator.vertices(zero)
    body = evaluator.body_frame_vertices(zero)
    np.testing.assert_allclose(camera, body * CAMERA_AXES + [0.1, 0.2, 3.0], atol=1e-12)


def test_the_reverse_mode_agrees_with_finite_differences(evaluator):
    rng = np.random.default_rng(3)
    parameters = random_parameters(rng)
    direction = rng.standard_normal(evaluator.model.mean_vertices.shape)

    def scalar(p: BodyParameters) -> float:
        vertices = evaluator.vertices(p)
        return float((direction * vertices).sum() + (vertices**2).sum())

    derivative = evaluator.derivative(parameters, direction + 2 * evaluator.vertices(parameters))
    zero = {"pose": np.zeros((3, 3)), "translation": np.zeros(3), "shape": np.zeros(2)}
    step = 1e-5
    for name in zero:
        for index in np.ndindex(zero[name].shape):
            plus = {key: value.copy() for key, value in zero.items()}
            minus = {key: value.copy() for key, value in zero.items()}
            plus[name][index] = step
            minus[name][index] = -step
            numeric = (
                scalar(increment(parameters, **plus)) - scalar(increment(parameters, **minus))
            ) / (2 * step)
            assert getattr(derivative, name)[index] == pytest.approx(numeric, rel=2e-5, abs=2e-5)


def test_a_stature_asked_for_is_a_stature_got(evaluator):
    shape = shape_for_height(evaluator, 1.37)
    assert height_of_shape(evaluator, shape) == pytest.approx(1.37, abs=1e-6)
    assert shape[1] == 0.0


def test_a_bone_is_turned_by_its_parents_rotation():
    """A quarter turn about z takes x to y."""
    rest = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
    turns = rotation_matrices(np.array([[0.0, 0.0, 0.0], [0.0, 0.0, np.pi / 2.0], [0.4, 0.2, 0.1]]))
    posed = posed_joints(rest, turns, np.array([-1, 0, 1]))
    np.testing.assert_allclose(
        posed, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]], atol=1e-12
    )
