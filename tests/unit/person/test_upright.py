"""Where the world is under a tilted camera."""

import numpy as np

from fitter.parameters import CameraTilt
from fitter.person.upright import upright_frame, upright_rotation, upright_turn
from fitter.vocabulary.outcomes import StanceKind

TILT = CameraTilt(
    pitch=np.radians(-12.0),
    roll=np.radians(3.0),
    covariance=np.eye(2),
    stances={StanceKind.STANDING: 1.0},
)


def test_a_level_camera_looks_along_minus_z():
    level = CameraTilt(pitch=0.0, roll=0.0, covariance=np.eye(2), stances=TILT.stances)
    frame = upright_frame(level, vertices=np.array([[0.0, 1.0, 3.0]]), root=np.array([0.2, 0, 3.0]))
    np.testing.assert_allclose(frame.rotation.T, np.diag([1.0, -1.0, -1.0]), atol=1e-15)
    np.testing.assert_allclose(frame.translation, [-0.2, 1.0, 3.0])


def test_what_is_above_in_the_camera_frame_is_above_in_the_world():
    vertices = np.random.default_rng(0).standard_normal((30, 3)) + [0.0, 0.0, 4.0]
    frame = upright_frame(TILT, vertices=vertices, root=vertices[0])
    world = frame.points(vertices)
    np.testing.assert_allclose(world[:, 1].min(), 0.0, atol=1e-12)
    np.testing.assert_allclose(world[0, [0, 2]], 0.0, atol=1e-12)
    heights = vertices @ TILT.up
    np.testing.assert_allclose(world[:, 1], heights - heights.min(), atol=1e-12)


def test_a_camera_that_looks_down_is_above_what_it_looks_at():
    ahead = np.array([[0.0, 0.0, 3.0]])
    frame = upright_frame(TILT, vertices=ahead, root=ahead[0])
    np.testing.assert_allclose(frame.translation[1], 3.0 * np.sin(np.radians(12.0)))


def test_a_turn_of_axes_with_y_up_is_the_rotation_of_the_camera_frame():
    body_axes = np.random.default_rng(1).standard_normal((5, 3))
    np.testing.assert_allclose(
        body_axes @ upright_turn(TILT).T, (body_axes * [1, -1, -1]) @ upright_rotation(TILT).T
    )
    np.testing.assert_array_equal(upright_turn(None), np.eye(3))
