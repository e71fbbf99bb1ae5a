"""Where our landmarks are, given the network's."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fitter.detection.body_landmarks import BodyLandmarks
from fitter.detection.landmark_meanings import (
    INDEX_OF_POINT,
    OFFSETS_M,
    RAISED_IN_PROFILE_M,
    own_pixels,
)

PIXELS_PER_METRE = 250.0
NOWHERE = np.array([320.0, 240.0])

# x left, y up, z forward, metres.
PERSON = {
    "shoulder": (0.18, 0.5, 0.0), "hip": (0.1, 0.0, 0.0), "knee": (0.1, -0.42, 0.0),
    "ankle": (0.1, -0.84, 0.0), "heel": (0.1, -0.9, -0.05), "toe": (0.1, -0.9, 0.15),
    "elbow": (0.25, 0.2, 0.0), "wrist": (0.3, -0.05, 0.0),
}  # fmt: skip

FACING_THE_CAMERA = np.diag([1.0, -1.0, -1.0])
LEFT_SIDE_TO_THE_CAMERA = np.array([[0.0, 0.0, -1.0], [0.0, -1.0, 0.0], [-1.0, 0.0, 0.0]])


def seen(to_camera: np.ndarray) -> BodyLandmarks:
    """A person far away, turned into camera axes."""
    world = np.zeros((33, 3))
    for name, place in PERSON.items():
        for side, sign in (("left", 1.0), ("right", -1.0)):
            world[INDEX_OF_POINT[f"{side}_{name}"]] = to_camera @ (np.array([sign, 1, 1]) * place)
    return BodyLandmarks(
        presence=1.0,
        pixels=NOWHERE + PIXELS_PER_METRE * world[:, :2],
        visibility=np.ones(33),
        world_m=world,
        mask=np.zeros((480, 640), dtype=np.float32),
    )


def moves_m(landmarks: BodyLandmarks, point: str) -> np.ndarray:
    index = INDEX_OF_POINT[point]
    return (own_pixels(landmarks) - landmarks.pixels)[index] / PIXELS_PER_METRE


def test_from_the_front_both_shoulders_move_down_and_outward():
    outward, up, _ = OFFSETS_M["shoulder"]
    front = seen(FACING_THE_CAMERA)
    np.testing.assert_allclose(moves_m(front, "left_shoulder"), [-outward, up], atol=1e-12)
    np.testing.assert_allclose(moves_m(front, "right_shoulder"), [outward, up], atol=1e-12)


def test_from_the_side_hips_move_back_and_shoulders_farther_down():
    # Forward is to the left of the picture.
    side = seen(LEFT_SIDE_TO_THE_CAMERA)
    for point in ("left_hip", "right_hip"):
        assert moves_m(side, point)[0] == pytest.approx(OFFSETS_M["hip"][2])
    down = OFFSETS_M["shoulder"][1] + RAISED_IN_PROFILE_M["shoulder"]
    assert moves_m(side, "left_shoulder")[1] == pytest.approx(down)


def test_moves_turn_with_the_picture():
    upright = seen(FACING_THE_CAMERA)
    turn = Rotation.from_rotvec([0.0, 0.0, 1.1]).as_matrix()
    turned = own_pixels(seen(turn @ FACING_THE_CAMERA)) - NOWHERE
    np.testing.assert_allclose(turned, (own_pixels(upright) - NOWHERE) @ turn[:2, :2].T, atol=1e-9)


def test_points_in_which_makers_disagree_stay():
    front = seen(FACING_THE_CAMERA)
    for point in ("nose", "left_eye", "right_elbow", "left_wrist"):
        np.testing.assert_array_equal(moves_m(front, point), 0.0)
