"""Landmarks of the body, and their offsets from points."""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fitter.detection.body_landmarks import MIRRORED, BodyLandmarks, LandmarkNetwork
from fitter.detection.landmark_meanings import (
    INDEX_OF_POINT,
    OFFSETS_M,
    RAISED_IN_PROFILE_M,
    own_pixels,
)
from fitter.detection.person_detector import DetectedPerson, FaceDetector
from tests.unit.detection.fake_networks import FakeNetwork, Outputs

NOSE, LEFT_WRIST, RIGHT_WRIST = 0, 15, 16


def answering(
    places: dict[int, tuple[float, float]],
    *,
    world: dict[int, tuple[float, float, float]] | None = None,
    heat: np.ndarray | None = None,
    mask: np.ndarray | None = None,
    faces: Callable[[np.ndarray], Outputs] | None = None,
) -> LandmarkNetwork:
    """Says the same of a picture and of its mirror image."""

    def answer(_: np.ndarray) -> Outputs:
        landmarks, in_world = np.zeros((39, 5)), np.zeros((39, 3))
        for index, place in places.items():
            landmarks[index, :2] = place
        for index, place in (world or {}).items():
            in_world[index] = place
        heat_map = np.full((64, 64, 39), -50.0) if heat is None else heat
        person = np.full((256, 256, 1), -50.0) if mask is None else mask
        return {
            (195,): landmarks.ravel(),
            (117,): in_world.ravel(),
            (64, 64, 39): heat_map,
            (256, 256, 1): person,
            (1,): np.array([0.9]),
        }

    return LandmarkNetwork(
        FakeNetwork(answer), FaceDetector(FakeNetwork(faces or face_in_the_middle(0.0)))
    )


def face_in_the_middle(certainty: float) -> Callable[[np.ndarray], Outputs]:
    """A face in the middle of whatever is shown, as certain as this."""

    def answer(_: np.ndarray) -> Outputs:
        scores, boxes = np.full((896, 1), -50.0), np.zeros((896, 16))
        scores[0] = np.log(max(certainty, 1e-9) / max(1.0 - certainty, 1e-9))
        # The tip of the nose from the first anchor, in the middle of the first of 16 cells.
        boxes[0, 8:10] = 60.0
        return {(896, 1): scores, (896, 16): boxes}

    return answer


TRUNK = {11: (160.0, 80.0), 12: (96.0, 80.0), 23: (148.0, 170.0), 24: (108.0, 170.0)}
"""Shoulders and hips of somebody who faces the camera, in pixels of the crop."""


def looking(*sides: float, face: float, cut_off: float = -1.0) -> LandmarkNetwork:
    """Sees a trunk from the front (1) or from behind (-1), as a picture is and in the mirror.

    ``cut_off`` is what it sees where the head is cut off.
    """
    looks = iter(sides)

    def answer(picture: np.ndarray) -> Outputs:
        side = next(looks) if picture[0].any() else cut_off
        landmarks, world = np.zeros((39, 5)), np.zeros((39, 3))
        landmarks[:, :2] = 128.0
        for index, (x, y) in TRUNK.items():
            landmarks[index, :2] = 128.0 + side * (x - 128.0), y
        return {
            (195,): landmarks.ravel(),
            (117,): world.ravel(),
            (64, 64, 39): np.full((64, 64, 39), -50.0),
            (256, 256, 1): np.full((256, 256, 1), -50.0),
            (1,): np.array([0.9]),
        }

    return LandmarkNetwork(FakeNetwork(answer), FaceDetector(FakeNetwork(face_in_the_middle(face))))


def is_front(network: LandmarkNetwork, **said: bool) -> bool:
    person = DetectedPerson(score=0.9, middle=np.array([200.0, 200.0]), rim=np.array([200.0, 97.6]))
    white = np.full((400, 400, 3), 255, dtype=np.uint8)
    found = network.landmarks(white, person, **said)
    return bool(found.pixels[11, 0] > found.pixels[12, 0])


def test_who_is_seen_from_behind_is_left_so():
    assert not is_front(looking(-1.0, -1.0, face=0.1))
    assert not is_front(looking(-1.0, -1.0, face=0.9, cut_off=1.0))


def test_where_no_face_is_seen_trunk_and_legs_say_which_way_somebody_faces():
    assert is_front(looking(-1.0, -1.0, face=0.1, cut_off=1.0))
    assert not is_front(looking(-1.0, -1.0, face=0.1, cut_off=1.0), from_behind=True)


def test_looks_that_contradict_are_not_averaged():
    for sides in ((1.0, -1.0), (-1.0, 1.0)):
        assert is_front(looking(*sides, face=0.1))


def seen(network: LandmarkNetwork, *, rim: tuple[float, float] = (200.0, 97.6)) -> BodyLandmarks:
    """Of a person at (200, 200) whose crop is as large as the network's input."""
    person = DetectedPerson(score=0.9, middle=np.array([200.0, 200.0]), rim=np.array(rim))
    return network.landmarks(np.zeros((400, 400, 3), dtype=np.uint8), person)


def test_the_face_of_somebody_beside_is_looked_for_farther_out_than_the_person_s_own():
    def answer(picture: np.ndarray) -> Outputs:
        found = dict(face_in_the_middle(0.9)(picture))
        if picture.max() > 0.0:
            found[896, 1][1], found[896, 16][1] = found[896, 1][0], found[896, 16][0]
            # Both anchors share a place; their boxes do not overlap.
            found[896, 16][:2, 0], found[896, 16][:2, 2:4] = (-20.0, 40.0), 20.0
        return found

    network = answering({}, faces=answer)
    picture = np.zeros((400, 400, 3), dtype=np.uint8)
    person = DetectedPerson(score=0.9, middle=np.array([200.0, 200.0]), rim=np.array([200.0, 97.6]))
    assert len(network.landmarks(picture, person).faces) == 1
    picture[60:84, 240:248] = 255  # 40 to 48 pixels from the head; half a square is 33 or 51
    assert len(network.landmarks(picture, person).faces) == 2
    unsure = answering({}, faces=face_in_the_middle(0.6)).landmarks(picture, person)
    assert (unsure.faces, unsure.face) == ((), pytest.approx(0.6))


def test_mirrored_twice_every_landmark_is_itself():
    np.testing.assert_array_equal(MIRRORED[MIRRORED], np.arange(33))
    assert MIRRORED[LEFT_WRIST] == RIGHT_WRIST
    assert MIRRORED[NOSE] == NOSE


def test_a_landmark_is_the_mean_of_both_looks():
    # In the mirror the wrists change places and sides.
    found = seen(answering({LEFT_WRIST: (200.0, 100.0), RIGHT_WRIST: (60.0, 120.0)}))
    expected = np.array([(200.0 + (256.0 - 60.0)) / 2.0, 110.0]) + 72.0
    np.testing.assert_allclose(found.pixels[LEFT_WRIST], expected, atol=1e-6)
    assert found.presence == pytest.approx(0.9)


def test_a_person_who_lies_is_shown_upright():
    # The circle's rim to the right of the hips: the picture's right is the crop's top.
    found = seen(
        answering({NOSE: (128.0, 28.0)}, world={NOSE: (0.0, -0.5, 0.1)}), rim=(302.4, 200.0)
    )
    np.testing.assert_allclose(found.pixels[NOSE], [300.0, 200.0], atol=1e-6)
    np.testing.assert_allclose(found.world_m[NOSE], [0.5, 0.0, 0.1], atol=1e-9)


def test_heat_near_a_landmark_places_it():
    heat = np.full((64, 64, 39), -50.0)
    heat[30, 34, NOSE] = 50.0
    heat[30, 29, NOSE] = 50.0  # the same in the mirror
    found = seen(answering({NOSE: (128.0, 122.0)}, heat=heat))
    np.testing.assert_allclose(found.pixels[NOSE], [200.0, 192.0], atol=2.0)


def test_no_heat_leaves_a_landmark_where_it_was_put():
    found = seen(answering({NOSE: (140.0, 122.0)}))
    # Mirrored it says 140 again, which is 116 unmirrored.
    np.testing.assert_allclose(found.pixels[NOSE], [200.0, 194.0], atol=1e-6)


def test_the_mask_lies_over_the_picture():
    mask = np.full((256, 256, 1), -50.0)
    mask[100:150, 78:178] = 50.0
    found = seen(answering({}, mask=mask))
    rows, columns = np.nonzero(found.mask > 0.5)
    assert (rows.min(), rows.max()) == (172, 221)
    assert (columns.min(), columns.max()) == (150, 249)


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


def seen_from(to_camera: np.ndarray) -> BodyLandmarks:
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
    front = seen_from(FACING_THE_CAMERA)
    np.testing.assert_allclose(moves_m(front, "left_shoulder"), [-outward, up], atol=1e-12)
    np.testing.assert_allclose(moves_m(front, "right_shoulder"), [outward, up], atol=1e-12)


def test_from_the_side_hips_move_back_and_shoulders_farther_down():
    # Forward is to the left of the picture.
    side = seen_from(LEFT_SIDE_TO_THE_CAMERA)
    for point in ("left_hip", "right_hip"):
        assert moves_m(side, point)[0] == pytest.approx(OFFSETS_M["hip"][2])
    down = OFFSETS_M["shoulder"][1] + RAISED_IN_PROFILE_M["shoulder"]
    assert moves_m(side, "left_shoulder")[1] == pytest.approx(down)


def test_moves_turn_with_the_picture():
    upright = seen_from(FACING_THE_CAMERA)
    turn = Rotation.from_rotvec([0.0, 0.0, 1.1]).as_matrix()
    turned = own_pixels(seen_from(turn @ FACING_THE_CAMERA)) - NOWHERE
    np.testing.assert_allclose(turned, (own_pixels(upright) - NOWHERE) @ turn[:2, :2].T, atol=1e-9)


def test_points_in_which_makers_disagree_stay():
    front = seen_from(FACING_THE_CAMERA)
    for point in ("nose", "left_eye", "right_elbow", "left_wrist"):
        np.testing.assert_array_equal(moves_m(front, point), 0.0)
