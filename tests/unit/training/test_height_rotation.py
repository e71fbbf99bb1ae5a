import numpy as np
import pytest

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
    gradient = RNG.normal(size=N)
    rotation = axes_for(linear_attribute(gradient)).rotation
    np.testing.assert_allclose(rotation[:, 0], gradient / np.linalg.norm(gradient), atol=1e-8)
    np.testing.assert_allclose(gradient @ rotation[:, 1:], 0.0, atol=1e-8)


def test_no_other_axis_changes_a_linear_attribute_at_three_deviations():
    attribute = linear_attribute(RNG.normal(size=N))
    changes = attribute_changes(attribute, list(axes_for(attribute).rotation[:, 1:].T), 3.0)
    assert changes.max() < 1e-8


@pytest.mark.parametrize("kind", [linear_attribute, curved_attribute])
def test_both_ends_of_every_other_axis_have_the_same_attribute(kind):
    attribute = kind(RNG.normal(size=N))
    for axis in axes_for(attribute).rotation[:, 1:].T:
        assert abs(attribute(3.0 * axis) - attribute(-3.0 * axis)) < 1e-7


def test_of_a_curved_attribute_only_the_even_part_is_left():
    gradient, bend = RNG.normal(size=N), RNG.normal(size=(N, N)) * 0.02

    def attribute(shape):
        return float(gradient @ shape + shape @ bend @ shape)

    for axis in axes_for(attribute).rotation[:, 1:].T:
        left = attribute_changes(attribute, [axis], 3.0)[0]
        np.testing.assert_allclose(left, abs(9.0 * axis @ bend @ axis), atol=1e-7)


@pytest.mark.parametrize("kind", [linear_attribute, curved_attribute])
def test_the_basis_stays_orthonormal(kind):
    rotation = axes_for(kind(RNG.normal(size=N))).rotation
    np.testing.assert_allclose(rotation.T @ rotation, np.eye(N), atol=1e-12)


def test_the_first_axes_span_what_they_spanned_before_absent_the_attributes_axis():
    gradient = RNG.normal(size=N)
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
    rotation = axes_for(linear_attribute(RNG.normal(size=N))).rotation
    sizes = np.linalg.norm(SIZES[:, None] * rotation[:, 1:], axis=0)
    assert (np.diff(sizes) <= 0).all()


def test_the_candidate_is_the_axis_most_correlated_with_the_attribute():
    values = COEFFICIENTS @ np.array([0.1, 0, 0, -2.0, 0, 1.0, 0, 0])
    assert most_correlated_axis(COEFFICIENTS, values) == 3


def test_changes_are_the_larger_of_both_ends():
    changes = attribute_changes(lambda s: float(s[0] + s[1] ** 2), list(np.eye(2)), 3.0)
    np.testing.assert_allclose(changes, [3.0, 9.0])
