import numpy as np
import pytest

from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import height_of_shape, rest_vertices
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.errors import DefinitionError
from fitter.training.shapes.attribute_spaces import attribute_space, gram_of_axes
from fitter.training.shapes.attributes import (
    measurement_attribute,
    path_between_landmarks,
    surface_length_attribute,
)
from fitter.training.shapes.height_rotation import attribute_changes

COEFFICIENTS = np.random.default_rng(5).normal(size=(60, 20))


@pytest.fixture(scope="module")
def model():
    return load_body_model(packaged_model_path("male"))


def test_a_measurement_is_an_attribute(model):
    stature = measurement_attribute(model, "stature")
    shape = COEFFICIENTS[0]
    np.testing.assert_allclose(
        stature(shape), 100.0 * height_of_shape(ScapeEvaluator(model), shape), atol=1e-6
    )


def test_an_unknown_measurement_is_refused_by_name(model):
    with pytest.raises(DefinitionError, match="third_elbow"):
        measurement_attribute(model, "third_elbow")


def test_a_length_over_the_arm_is_longer_than_the_straight_line_and_not_by_much(model):
    path = path_between_landmarks(model, "right_acromion", "right_finger_tip")
    points = path.points(model.mean_vertices)
    straight = np.linalg.norm(points[-1] - points[0])
    assert straight < path.length_m(model.mean_vertices) < 1.15 * straight


def test_a_length_over_the_surface_is_the_geodesic_of_other_bodies_within_a_percent(model):
    path = path_between_landmarks(model, "right_acromion", "right_wrist")
    fixed = surface_length_attribute(model, path)
    for shape in COEFFICIENTS[:3]:
        body = rest_vertices(model, shape)
        anew = path_between_landmarks(model, "right_acromion", "right_wrist", body).length_m(body)
        assert abs(fixed(shape) - 100.0 * anew) < anew


@pytest.mark.parametrize("name", ["weight", "waist_girth_navel"])
def test_one_axis_carries_a_measured_attribute(model, name):
    attribute = measurement_attribute(model, name)
    turned = attribute_space(model, attribute, COEFFICIENTS)
    again = measurement_attribute(turned.model, name)
    axes = np.eye(20)
    along = 0.5 * (again(3.0 * axes[0]) - again(-3.0 * axes[0]))
    leak = attribute_changes(again, list(axes[1:]), 3.0).max()
    assert along > 20.0
    assert leak < 0.04 * along


def test_a_turned_model_spans_the_same_bodies(model):
    path = path_between_landmarks(model, "cervicale", "crotch")
    turned = attribute_space(model, surface_length_attribute(model, path), COEFFICIENTS)
    np.testing.assert_allclose(turned.turn.T @ turned.turn, np.eye(20), atol=1e-12)
    shape = COEFFICIENTS[7]
    np.testing.assert_allclose(
        rest_vertices(turned.model, shape @ turned.turn), rest_vertices(model, shape), atol=1e-12
    )


def test_the_largest_axes_come_first_after_the_attributes_own(model):
    sizes = np.diag(gram_of_axes(model))
    assert (np.diff(sizes[1:]) < 1e-12).all()
