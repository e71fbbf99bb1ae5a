"""People in a picture, and the square about one."""

import cv2
import numpy as np
import pytest

from fitter.detection.network import SquareCrop
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


def picture_with_a_spot(x: float, y: float) -> np.ndarray:
    """A soft white spot on black, 300 x 200, centred at continuous pixels."""
    columns, rows = np.meshgrid(np.arange(300) + 0.5, np.arange(200) + 0.5)
    spot = np.exp(-0.5 * ((columns - x) ** 2 + (rows - y) ** 2) / 4.0**2)
    return np.repeat((255.0 * spot)[:, :, None], 3, axis=2).round().astype(np.uint8)


def centre_of(values: np.ndarray) -> np.ndarray:
    rows, columns = np.indices(values.shape)
    weights = values / values.sum()
    return np.array([(weights * (columns + 0.5)).sum(), (weights * (rows + 0.5)).sum()])


@pytest.mark.parametrize("side", [80.0, 260.0])
@pytest.mark.parametrize("angle", [0.0, 0.5, -2.5])
def test_a_spot_in_the_crop_is_where_the_crop_says(angle, side):
    place = np.array([151.3, 98.2])
    crop = SquareCrop(centre=np.array([150.0, 100.0]), side=side, angle=angle, size=64)
    cut = crop.cut_from(picture_with_a_spot(*place))
    seen = centre_of(cut[:, :, 0].astype(float))
    np.testing.assert_allclose(crop.in_picture(seen[None])[0], place, atol=0.1)


@pytest.mark.parametrize("angle", [0.0, 1.1])
def test_what_is_put_back_lies_where_it_was_cut(angle):
    place = np.array([140.7, 110.4])
    crop = SquareCrop(centre=np.array([150.0, 100.0]), side=120.0, angle=angle, size=128)
    cut = crop.cut_from(picture_with_a_spot(*place))[:, :, 0].astype(np.float32)
    back = crop.put_back(cut, width=300, height=200)
    assert back.shape == (200, 300)
    np.testing.assert_allclose(centre_of(back), place, atol=0.1)


def test_beyond_the_picture_all_is_black():
    crop = SquareCrop(centre=np.array([0.0, 0.0]), side=100.0, angle=0.0, size=50)
    cut = crop.cut_from(np.full((200, 300, 3), 255, dtype=np.uint8))
    assert cut[:20, :20].max() == 0
    assert cut[30:, 30:].min() == 255


def test_fine_stripes_are_averaged_and_not_sampled():
    stripes = np.zeros((256, 256, 3), dtype=np.uint8)
    stripes[::2] = 255
    crop = SquareCrop(centre=np.array([128.0, 128.0]), side=256.0, angle=0.0, size=32)
    inner = crop.cut_from(stripes)[4:-4, 4:-4].astype(float)
    assert abs(inner.mean() - 127.5) < 2.0
    assert cv2.meanStdDev(inner)[1].max() < 5.0
