import numpy as np

from fitter.numerics.rotations import rotation_matrices
from fitter.training.articulation.rig import partial_rotations, swing_and_twist

RNG = np.random.default_rng(5)
VECTORS = RNG.normal(scale=1.2, size=(200, 3))
AXES = RNG.normal(size=(200, 3))
AXES /= np.linalg.norm(AXES, axis=1, keepdims=True)


def test_swing_after_twist_gives_the_rotation_back():
    whole = partial_rotations(VECTORS, AXES, np.ones(200), np.ones(200))
    np.testing.assert_allclose(whole, rotation_matrices(VECTORS), atol=1e-9)


def test_a_swing_has_no_part_along_the_twist_axis():
    swing, _ = swing_and_twist(VECTORS, AXES)
    np.testing.assert_allclose(np.einsum("ki,ki->k", swing, AXES), 0.0, atol=1e-9)


def test_a_turn_about_the_axis_is_all_twist():
    angles = RNG.uniform(-3.0, 3.0, 200)
    swing, twist = swing_and_twist(angles[:, None] * AXES, AXES)
    np.testing.assert_allclose(twist, angles, atol=1e-9)
    np.testing.assert_allclose(swing, 0.0, atol=1e-7)


def test_no_share_of_a_rotation_is_no_rotation():
    none = partial_rotations(VECTORS, AXES, np.zeros(200), np.zeros(200))
    np.testing.assert_allclose(none, np.broadcast_to(np.eye(3), (200, 3, 3)), atol=1e-12)
