"""Axes that carry height or another attribute alone."""

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
from fitter.training.shapes.height_rotation import (
    attribute_changes,
    attribute_preserving_axes,
    most_correlated_axis,
)

N = 8
RNG = np.random.default_rng(11)
COEFFICIENTS = RNG.normal(size=(500, N))
SIZES = np.linspace(2.0, 0.1, N)
GRAM = np.diag(SIZES**2)


def linear_attribute(gradient):
    return lambda shape: 1.7 + float(gradient @ shape)


def curved_attribute(gradient):
    return lambda shape: 1.7 + float(np.sinh(0.4 * gradient @ shape) + 0.01 * shape[2] ** 2)


def axes_for(attribute):
    values = np.array([attribute(c) for c in COEFFICIENTS])
    return attribute_preserving_axes(attribute, COEFFICIENTS, values, GRAM)


def test_a_linear_attribute_is_carried_by_its_gradient_alone():
    draws = np.random.default_rng(12)
    gradient = draws.normal(size=N)
    rotation = axes_for(linear_attribute(gradient)).rotation
    np.testing.assert_allclose(rotation[:, 0], gradient / np.linalg.norm(gradient), atol=1e-8)
    np.testing.assert_allclose(gradient @ rotation[:, 1:], 0.0, atol=1e-8)


@pytest.mark.parametrize("kind", [linear_attribute, curved_attribute])
def test_both_ends_of_every_other_axis_have_the_same_attribute(kind):
    draws = np.random.default_rng(12)
    attribute = kind(draws.normal(size=N))
    for axis in axes_for(attribute).rotation[:, 1:].T:
        assert abs(attribute(3.0 * axis) - attribute(-3.0 * axis)) < 1e-7


def test_of_a_curved_attribute_only_the_even_part_is_left():
    draws = np.random.default_rng(12)
    gradient, bend = draws.normal(size=N), draws.normal(size=(N, N)) * 0.02

    def attribute(shape):
        return float(gradient @ shape + shape @ bend @ shape)

    for axis in axes_for(attribute).rotation[:, 1:].T:
        left = attribute_changes(attribute, [axis], 3.0)[0]
        np.testing.assert_allclose(left, abs(9.0 * axis @ bend @ axis), atol=1e-7)


@pytest.mark.parametrize("kind", [linear_attribute, curved_attribute])
def test_the_basis_stays_orthonormal(kind):
    draws = np.random.default_rng(12)
    rotation = axes_for(kind(draws.normal(size=N))).rotation
    np.testing.assert_allclose(rotation.T @ rotation, np.eye(N), atol=1e-12)


def test_the_first_axes_span_what_they_spanned_before_absent_the_attributes_axis():
    draws = np.random.default_rng(12)
    gradient = draws.normal(size=N)
    found = axes_for(linear_attribute(gradient))
    k = found.candidate
    kept = [j for j in range(N) if j != k]
    # Each new axis is one old axis moved toward e_k and the old ones before it.
    for count in range(1, len(kept) + 1):
        before = np.eye(N)[:, [*kept[:count], k]]
        span = [
            column
            for column in found.rotation[:, 1:].T
            if np.allclose(before @ before.T @ column, column, atol=1e-8)
        ]
        assert len(span) >= count


def test_more_of_the_first_axis_is_more_of_the_attribute():
    for sign in (-1.0, 1.0):
        attribute = linear_attribute(sign * np.eye(N)[3] + 0.1)
        first = axes_for(attribute).rotation[:, 0]
        assert attribute(first) > attribute(-first)


def test_the_other_axes_come_largest_first():
    draws = np.random.default_rng(12)
    rotation = axes_for(linear_attribute(draws.normal(size=N))).rotation
    sizes = np.linalg.norm(SIZES[:, None] * rotation[:, 1:], axis=0)
    assert (np.diff(sizes) <= 0).all()


def test_the_candidate_is_the_axis_most_correlated_with_the_attribute():
    values = COEFFICIENTS @ np.array([0.1, 0, 0, -2.0, 0, 1.0, 0, 0])
    assert most_correlated_axis(COEFFICIENTS, values) == 3


def test_changes_are_the_larger_of_both_ends():
    changes = attribute_changes(lambda s: float(s[0] + s[1] ** 2), list(np.eye(2)), 3.0)
    np.testing.assert_allclose(changes, [3.0, 9.0])


GENERATOR = np.random.default_rng(3)
COUNT = 6
PEOPLE = GENERATOR.normal(size=(4000, COUNT))
GRADIENT = GENERATOR.normal(size=COUNT)
SHAPES = np.random.default_rng(5).normal(size=(60, 20))
VALUES = 1.7 + PEOPLE @ GRADIENT


def height(shape):
    return 1.7 + float(GRADIENT @ shape)


def test_the_first_axis_points_where_the_attribute_covaries():
    axis = blanz_vetter_axes(PEOPLE, VALUES, np.eye(COUNT))[0]
    assert axis @ GRADIENT / np.linalg.norm(GRADIENT) > 0.999


def test_the_other_axes_are_orthogonal_to_the_first_in_the_mesh_metric():
    gram = np.diag(np.linspace(4.0, 0.1, COUNT))
    axes = blanz_vetter_axes(PEOPLE, VALUES, gram)
    assert axes.shape == (COUNT, COUNT)
    np.testing.assert_allclose(axes[1:] @ gram @ axes[0], 0.0, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(axes, axis=1), 1.0)


def test_orthogonal_directions_leak_the_attribute_unless_all_axes_weigh_alike():
    even = blanz_vetter_leak(height, PEOPLE, VALUES, np.eye(COUNT))
    uneven = blanz_vetter_leak(height, PEOPLE, VALUES, np.diag(np.linspace(4.0, 0.1, COUNT)))
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
