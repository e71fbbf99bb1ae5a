"""Rotation vectors and matrices."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.spatial.transform import Rotation

from fitter.numerics.rotations import (
    compose,
    rotation_matrices,
    rotation_vectors,
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
