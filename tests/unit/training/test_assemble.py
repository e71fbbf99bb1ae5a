from dataclasses import replace

import numpy as np
import pytest

from fitter.body.model import regress
from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import rest_vertices
from fitter.body.storage import load_body_model, save_body_model
from fitter.numerics.meshes import enclosed_volume
from fitter.parameters import BodyParameters
from fitter.training.articulation.parts import part_index
from fitter.training.articulation.pose_term import PoseExample
from fitter.training.assemble import (
    assemble_body_model,
    height_attribute,
    mirrored_example,
    model_arrays,
)
from fitter.training.report import held_out_figures as figures
from fitter.training.report.header_figures import earlier_methods
from fitter.training.report.held_out_figures import (
    PosedBody,
    held_out_figures,
    posed_error,
    shape_error,
)
from tests.unit.training.synthetic_population import landmarks, part_weights, population, surface

HEADER = {
    "gender": "male",
    "units": "metres",
    "sources": ["ellipsoids"],
    "licences": ["CC0-1.0"],
    "seed": 1,
}


def train():
    return assemble_body_model(
        population(80, 1),
        surface(),
        part_weights(),
        landmarks(),
        header=HEADER,
        example_count=0,
        rng=np.random.default_rng(2),
    )


@pytest.fixture(scope="module")
def trained():
    return train()


def test_bodies_of_the_planted_space_are_rebuilt(trained):
    error = shape_error(trained.model, population(30, 9).rest)
    assert error.by_vertex < 0.01
    assert error.by_area < 0.01


def test_what_the_space_lacks_is_counted_in_millimetres(trained):
    bodies = population(30, 9).rest
    bump = np.zeros_like(bodies)
    bump[:, ::2, 2] = 0.004
    bump[:, 1::2, 2] = -0.004
    assert 3.0 < shape_error(trained.model, bodies + bump).by_vertex < 4.5


def test_only_the_first_axis_changes_height(trained):
    height = height_attribute(trained.model)
    still = height(np.zeros(20))
    assert height(np.eye(20)[0]) > still + 0.01
    for axis in np.eye(20)[1:]:
        assert abs(height(3.0 * axis) - still) < 1e-6


def test_height_follows_its_axis_on_people_not_trained_on(trained, monkeypatch):
    monkeypatch.setattr(figures, "POSED_EXAMPLES", 30)
    bodies = population(30, 9)
    exact = ScapeEvaluator(
        replace(
            trained.model,
            shape_basis=bodies.rest - trained.model.mean_vertices,
            pose_feature_strengths=np.zeros((*trained.model.pose_feature_strengths.shape[:2], 30)),
        )
    )

    def posed(subject, pose):
        return exact.body_frame_vertices(
            BodyParameters(pose=pose, translation=np.zeros(3), shape=np.eye(30)[subject])
        )

    found = held_out_figures(trained.model, replace(bodies, posed=posed))
    assert found["height_correlation"] > 0.99
    assert found["height_change_at_3_deviations_mm"] < 1e-3
    # These people are posed by the model's own parts, so what it has wrong is nothing.
    assert found["posed_mm"] < 0.01


def test_more_of_any_other_axis_is_a_fuller_body(trained):
    model = trained.model
    for axis in model.shape_basis[1:]:
        fuller, thinner = (
            enclosed_volume(model.mean_vertices + sign * axis, model.triangles)
            for sign in (1.0, -1.0)
        )
        assert fuller >= thinner


def test_training_coefficients_are_whitened_after_the_rotation(trained):
    np.testing.assert_allclose(np.cov(trained.coefficients.T), np.eye(20), atol=1e-9)
    rebuilt = rest_vertices(trained.model, trained.coefficients[5])
    wanted = population(80, 1).rest[5]
    np.testing.assert_allclose(
        rebuilt - rebuilt.mean(axis=0), wanted - wanted.mean(axis=0), atol=1e-6
    )


def test_the_root_joint_lies_at_the_origin_for_every_shape(trained):
    shape = np.random.default_rng(0).normal(size=20)
    body = rest_vertices(trained.model, shape)
    np.testing.assert_allclose(regress(trained.model.joint_regressor, body)[0], 0.0, atol=1e-7)


def test_a_whole_turn_moves_the_model_rigidly(trained):
    model = trained.model
    pose = np.zeros((17, 3))
    pose[0] = [0.0, np.pi / 2, 0.0]
    turned = ScapeEvaluator(model).body_frame_vertices(
        BodyParameters(pose=pose, translation=np.zeros(3), shape=np.zeros(20))
    )
    expected = model.mean_vertices @ np.array([[0, 0, -1.0], [0, 1, 0], [1.0, 0, 0]])
    np.testing.assert_allclose(turned, expected, atol=1e-6)


def at_rest(trained, offset: np.ndarray) -> list[PosedBody]:
    """Mean bodies in the rest pose, that far off."""
    model = trained.model
    body = PosedBody(
        shape=np.zeros(20), pose=np.zeros((17, 3)), vertices=model.mean_vertices + offset
    )
    return [body] * 3


def test_only_what_a_translation_leaves_is_a_posed_error(trained):
    assert posed_error(trained.model, at_rest(trained, np.array([0.1, 0.2, 0.3]))).by_vertex < 1e-4
    bump = np.zeros_like(trained.model.mean_vertices)
    bump[::2, 2], bump[1::2, 2] = 0.01, -0.01
    found = posed_error(trained.model, at_rest(trained, bump))
    assert found.by_vertex == pytest.approx(10.0, abs=0.1)


def test_directions_orthogonal_as_shapes_leak_height(trained):
    assert earlier_methods(trained)["blanz_vetter_height_change_mm"] > 1.0


def test_the_model_survives_its_file(trained, tmp_path):
    model = trained.model
    header = HEADER | {
        "part_names": list(model.part_names),
        "landmark_names": list(model.landmarks.names),
    }
    path = tmp_path / "male.npz"
    save_body_model(path, header=header, arrays=model_arrays(model))
    loaded = load_body_model(path)
    np.testing.assert_allclose(loaded.shape_basis, model.shape_basis, atol=1e-7)
    np.testing.assert_array_equal(loaded.mean_vertices, model.mean_vertices)


def test_a_mirrored_example_is_the_other_side_in_the_other_sides_pose():
    rng = np.random.default_rng(3)
    left, right = part_index("left_forearm"), part_index("right_forearm")
    pose = np.zeros((17, 3))
    pose[left] = [0.3, -0.2, 0.1]
    points = rng.normal(size=(4, 3))
    example = PoseExample(rest=points, posed=points + 1.0, pose=pose, shape=np.arange(3.0))
    swapped = np.array([1, 0, 3, 2])
    found = mirrored_example(example, swapped)
    np.testing.assert_array_equal(found.pose[right], [0.3, 0.2, -0.1])
    assert not found.pose[left].any()
    np.testing.assert_array_equal(found.rest[0], points[1] * [-1.0, 1.0, 1.0])
    again = mirrored_example(found, swapped)
    np.testing.assert_array_equal(again.posed, example.posed)
    np.testing.assert_array_equal(again.pose, example.pose)
