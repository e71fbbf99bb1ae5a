"""How rotation vectors move."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from fitter.numerics.rotations import compose, inverse_left_jacobians

vectors = arrays(np.float64, (3, 3), elements=st.floats(-1.7, 1.7))


@given(vectors)
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
