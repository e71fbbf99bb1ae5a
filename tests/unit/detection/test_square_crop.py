"""Squares cut out of a picture and put back."""

import cv2
import numpy as np
import pytest

from fitter.detection.network import SquareCrop


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
