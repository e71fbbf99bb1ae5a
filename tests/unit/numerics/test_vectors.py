"""Vector products."""

import numpy as np

from fitter.numerics.rotations import cross_products, unit_vectors


def test_cross_products_broadcast_and_agree_with_numpy():
    rng = np.random.default_rng(0)
    first, second = rng.standard_normal((4, 1, 3)), rng.standard_normal((5, 3))
    np.testing.assert_allclose(cross_products(first, second), np.cross(first, second), atol=1e-15)


def test_unit_vectors_have_length_one_and_zero_stays_zero():
    vectors = np.array([[3.0, 0.0, 4.0], [0.0, 0.0, 0.0]])
    np.testing.assert_allclose(unit_vectors(vectors), [[0.6, 0.0, 0.8], [0.0, 0.0, 0.0]])
