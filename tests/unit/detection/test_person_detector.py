"""What the first network's numbers mean."""

import numpy as np
import pytest

from fitter.detection.person_detector import PersonDetector
from tests.unit.detection.fake_networks import FakeNetwork, Outputs

ANCHORS = 28 * 28 * 2 + 14 * 14 * 2 + 7 * 7 * 6
FIRST_OF_STRIDE_32 = 28 * 28 * 2 + 14 * 14 * 2


def answering(
    detections: dict[int, tuple[float, np.ndarray]],
) -> PersonDetector:
    """A detector whose anchors say so: score, and offsets of box, size and keypoints in pixels."""

    def answer(_: np.ndarray) -> Outputs:
        scores, values = np.full((ANCHORS, 1), -100.0), np.zeros((ANCHORS, 12))
        for anchor, (score, row) in detections.items():
            scores[anchor] = np.log(score / (1.0 - score))
            values[anchor] = row
        return {scores.shape: scores, values.shape: values}

    return PersonDetector(FakeNetwork(answer))


def row(hips: tuple[float, float], rim: tuple[float, float]) -> np.ndarray:
    return np.array([0.0, 0.0, 20.0, 20.0, *hips, *rim, 0.0, 0.0, 0.0, 0.0])


SQUARE = np.zeros((448, 448, 3), dtype=np.uint8)


def test_keypoints_are_offsets_from_the_anchors_cell():
    # The fourth cell of the coarsest grid, six anchors a cell: its centre is at (112, 16).
    anchor = FIRST_OF_STRIDE_32 + 6 * 3
    (person,) = answering({anchor: (0.9, row((8.0, 100.0), (8.0, 20.0)))}).persons(SQUARE)
    # The picture is twice as large as the network's.
    np.testing.assert_allclose(person.middle, [240.0, 232.0], atol=1e-6)
    np.testing.assert_allclose(person.rim, [240.0, 72.0], atol=1e-6)
    assert person.radius == pytest.approx(160.0)
    assert person.score == pytest.approx(0.9)


def test_a_wide_picture_is_shown_in_the_middle_of_a_square():
    anchor = FIRST_OF_STRIDE_32 + 6 * 3
    wide = np.zeros((224, 448, 3), dtype=np.uint8)
    (person,) = answering({anchor: (0.9, row((0.0, 96.0), (0.0, 20.0)))}).persons(wide)
    np.testing.assert_allclose(person.middle, [224.0, 112.0], atol=1e-6)


def test_detections_of_one_person_are_blended_by_their_scores():
    first, second = FIRST_OF_STRIDE_32, FIRST_OF_STRIDE_32 + 1
    detector = answering(
        {
            first: (0.8, row((0.0, 0.0), (0.0, -10.0))),
            second: (0.6, row((7.0, 0.0), (7.0, -10.0))),
        }
    )
    (person,) = detector.persons(SQUARE)
    assert person.middle[0] == pytest.approx(2.0 * (16.0 + 7.0 * 0.6 / 1.4))
    assert person.score == pytest.approx(0.8)


def test_people_apart_are_told_apart_the_largest_first():
    near, far = FIRST_OF_STRIDE_32, FIRST_OF_STRIDE_32 + 6 * 6
    detector = answering(
        {
            near: (0.8, row((0.0, 0.0), (0.0, -40.0))),
            far: (0.9, row((0.0, 0.0), (0.0, -10.0))),
        }
    )
    assert [round(each.score, 3) for each in detector.persons(SQUARE)] == [0.8, 0.9]


def test_the_whole_and_nearer_of_two_people_comes_before_one_at_the_border():
    whole, cut_off = FIRST_OF_STRIDE_32 + 6 * 24, FIRST_OF_STRIDE_32 + 6 * 48
    detector = answering(
        {
            whole: (0.8, row((0.0, 0.0), (0.0, -60.0))),
            cut_off: (0.9, row((0.0, 0.0), (0.0, -80.0))),
        }
    )
    assert [round(each.score, 3) for each in detector.persons(SQUARE)] == [0.8, 0.9]


def test_who_is_not_sure_to_be_there_is_nobody():
    assert answering({0: (0.4, row((0.0, 0.0), (0.0, -40.0)))}).persons(SQUARE) == ()
