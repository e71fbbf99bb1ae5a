import numpy as np

from fitter.training.shapes.attribute_comparisons import (
    allen_leak,
    allen_map,
    blanz_vetter_axes,
    blanz_vetter_leak,
)

RNG = np.random.default_rng(3)
N = 6
COEFFICIENTS = RNG.normal(size=(4000, N))
GRADIENT = RNG.normal(size=N)
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


def test_a_linear_map_is_recovered():
    matrix, constant = RNG.normal(size=(N, 2)), RNG.normal(size=N)
    attributes = RNG.normal(size=(50, 2))
    found = allen_map(attributes @ matrix.T + constant, attributes)
    np.testing.assert_allclose(found.matrix, matrix, atol=1e-12)
    np.testing.assert_allclose(found.shapes(attributes), attributes @ matrix.T + constant)


def test_a_linear_map_keeps_an_attribute_that_is_linear_in_the_shape():
    attributes = np.stack([VALUES, COEFFICIENTS @ RNG.normal(size=N)], axis=1)
    mapped = allen_map(COEFFICIENTS, attributes)
    assert allen_leak(height, mapped, attributes, kept=0) < 1e-9
