import numpy as np
import pytest

from fitter.body.shape_space import rest_vertices
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.numerics.meshes import enclosed_volume
from fitter.training.shapes.attribute_spaces import (
    attribute_space,
    blanz_vetter_axes,
    blanz_vetter_leak,
    gram_of_axes,
)
from fitter.training.shapes.height_rotation import attribute_changes

RNG = np.random.default_rng(3)
N = 6
COEFFICIENTS = RNG.normal(size=(4000, N))
GRADIENT = RNG.normal(size=N)
SHAPES = np.random.default_rng(5).normal(size=(60, 20))
VALUES = 1.7 + COEFFICIENTS @ GRADIENT


def height(shape):
    return 1.7 + float(GRADIENT @ shape)


def test_the_first_axis_points_where_the_attribute_covaries():
    axis = blanz_vetter_axes(COEFFICIENTS, VALUES, np.eye(N))[0]
    assert axis @ GRADIENT / np.linalg.norm(GRADIENT) > 0.999


def test_the_other_axes_are_orthogonal_to_the_first_in_the_mesh_metric():
    gram = np.diag(np.linspace(4.0, 0.1, N))
    axes = blanz_vetter_axes(COEFFICIENTS, VALUES, gram)
    assert axes.shape == (N, N)
    np.testing.assert_allclose(axes[1:] @ gram @ axes[0], 0.0, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(axes, axis=1), 1.0)


def test_orthogonal_directions_leak_the_attribute_unless_all_axes_weigh_alike():
    even = blanz_vetter_leak(height, COEFFICIENTS, VALUES, np.eye(N))
    uneven = blanz_vetter_leak(height, COEFFICIENTS, VALUES, np.diag(np.linspace(4.0, 0.1, N)))
    assert even < 0.15 * np.linalg.norm(GRADIENT)
    assert uneven > 5.0 * even


@pytest.fixture(scope="module")
def model():
    return load_body_model(packaged_model_path("male"))


def weight_attribute(model):
    return lambda shape: 1000.0 * enclosed_volume(rest_vertices(model, shape), model.triangles)


def test_one_axis_carries_an_attribute_that_is_not_linear(model):
    turned = attribute_space(model, weight_attribute(model), SHAPES)
    again = weight_attribute(turned.model)
    axes = np.eye(20)
    along = 0.5 * (again(3.0 * axes[0]) - again(-3.0 * axes[0]))
    assert along > 20.0
    assert attribute_changes(again, list(axes[1:]), 3.0).max() < 0.04 * along


def test_a_turned_model_spans_the_same_bodies(model):
    turned = attribute_space(model, weight_attribute(model), SHAPES)
    np.testing.assert_allclose(turned.turn.T @ turned.turn, np.eye(20), atol=1e-12)
    np.testing.assert_allclose(
        rest_vertices(turned.model, SHAPES[7] @ turned.turn),
        rest_vertices(model, SHAPES[7]),
        atol=1e-12,
    )


def test_the_largest_axes_come_first_after_the_attributes_own(model):
    sizes = np.diag(gram_of_axes(model))
    assert (np.diff(sizes[1:]) < 1e-12).all()
