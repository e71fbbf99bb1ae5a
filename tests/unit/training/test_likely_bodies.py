import numpy as np
import pytest

from fitter.training.shapes.likely_bodies import body_of_weight, random_shapes, weight_direction

GRADIENT = np.array([5.0, 3.0, 0.0, -4.0])


def weight(shape):
    return 70.0 + float(GRADIENT @ shape) + 0.1 * float(shape @ shape)


def test_the_direction_of_weight_leaves_height_alone():
    np.testing.assert_allclose(weight_direction(weight, 4), [0.0, 0.6, 0.0, -0.8], atol=1e-12)


def test_a_body_of_a_weight_is_found_beside_the_one_it_starts_from():
    start = np.array([1.5, 0.0, 0.0, 0.0])
    found = body_of_weight(weight, start, weight_direction(weight, 4), 70.0)
    assert weight(found) == pytest.approx(70.0)
    assert found[0] == start[0]


def test_a_weight_out_of_reach_is_refused():
    with pytest.raises(ValueError, match="sign"):
        body_of_weight(weight, np.zeros(4), weight_direction(weight, 4), 900.0)


def test_random_bodies_repeat_with_their_seed():
    first, second = (random_shapes(5, 3, np.random.default_rng(7)) for _ in range(2))
    np.testing.assert_array_equal(first, second)
    assert first.shape == (5, 3)
