"""Rotations, their Jacobians, and products of vectors."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.spatial.transform import Rotation

from fitter.numerics.rotations import (
    compose,
    cross_products,
    inverse_left_jacobians,
    rotation_matrices,
    rotation_vectors,
    unit_vectors,
)

vectors = arrays(np.float64, (4, 3), elements=st.floats(-3.0, 3.0))


@given(vectors)
def test_matrices_agree_with_an_independent_library(v):
    np.testing.assert_allclose(
        rotation_matrices(v), Rotation.from_rotvec(v).as_matrix(), atol=1e-12
    )


@given(vectors)
def test_vectors_give_back_their_matrices(v):
    matrices = rotation_matrices(v)
    back = rotation_vectors(matrices)
    np.testing.assert_allclose(rotation_matrices(back), matrices, atol=1e-9)
    assert (np.linalg.norm(back, axis=1) <= np.pi + 1e-12).all()


def test_half_turns_have_no_pole():
    v = np.pi * np.eye(3)
    np.testing.assert_allclose(
        rotation_matrices(rotation_vectors(rotation_matrices(v))), rotation_matrices(v), atol=1e-9
    )


@given(vectors, vectors)
def test_composition_multiplies_matrices(a, b):
    np.testing.assert_allclose(
        rotation_matrices(compose(a, b)), rotation_matrices(a) @ rotation_matrices(b), atol=1e-9
    )


short_vectors = arrays(np.float64, (3, 3), elements=st.floats(-1.7, 1.7))


@given(short_vectors)
def test_inverse_left_jacobian_is_the_derivative_of_a_further_turn(v):
    step = 1e-5
    matrices = inverse_left_jacobians(v)
    for axis in range(3):
        ahead = np.tile(step * np.eye(3)[axis], (3, 1))
        slope = (compose(ahead, v) - compose(-ahead, v)) / (2 * step)
        np.testing.assert_allclose(matrices[:, :, axis], slope, atol=1e-6)


def test_small_turns_join_smoothly():
    v = np.array([[0.99e-4, 0, 0], [1.01e-4, 0, 0]])
    first, second = inverse_left_jacobians(v)
    np.testing.assert_allclose(first, second, atol=2e-6)


def test_any_leading_shape_is_kept():
    assert inverse_left_jacobians(np.zeros((2, 5, 3))).shape == (2, 5, 3, 3)


def test_cross_products_broadcast_and_agree_with_numpy():
    rng = np.random.default_rng(0)
    first, second = rng.standard_normal((4, 1, 3)), rng.standard_normal((5, 3))
    np.testing.assert_allclose(cross_products(first, second), np.cross(first, second), atol=1e-15)


def test_unit_vectors_have_length_one_and_zero_stays_zero():
    vectors = np.array([[3.0, 0.0, 4.0], [0.0, 0.0, 0.0]])
    np.testing.assert_allclose(unit_vectors(vectors), [[0.6, 0.0, 0.8], [0.0, 0.0, 0.0]])
