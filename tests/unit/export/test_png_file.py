import io

import cv2
import numpy as np
import pytest
from PIL import Image as PillowImage

from fitter.export.display import png_file

DRAWS = np.random.default_rng(5)


def smooth_picture(height, width, channels):
    """Slopes, noise on a part of them, and a large even part."""
    y, x, c = np.mgrid[:height, :width, :channels]
    picture = 40.0 + 0.3 * x + 0.2 * y + 9.0 * c
    picture[: height // 2, : width // 2] += DRAWS.normal(
        0.0, 4.0, (height // 2, width // 2, channels)
    )
    picture[height // 2 :, width // 2 :] = 255.0
    return picture.clip(0.0, 255.0).astype(np.uint8)


@pytest.mark.parametrize("channels", [1, 3, 4])
@pytest.mark.parametrize(("height", "width"), [(1, 1), (3, 7), (240, 321)])
def test_pictures_are_read_by_others_as_they_were_written(height, width, channels):
    levels = smooth_picture(height, width, channels)
    content = png_file(levels)
    with PillowImage.open(io.BytesIO(content)) as picture:
        picture.verify()
    with PillowImage.open(io.BytesIO(content)) as picture:
        assert picture.mode == {1: "L", 3: "RGB", 4: "RGBA"}[channels]
        np.testing.assert_array_equal(np.asarray(picture).reshape(levels.shape), levels)
    read = cv2.imdecode(np.frombuffer(content, np.uint8), cv2.IMREAD_UNCHANGED)
    assert read is not None
    order = [0] if channels == 1 else [2, 1, 0, 3][:channels]
    np.testing.assert_array_equal(read.reshape(levels.shape)[..., order], levels)


def test_files_are_about_as_large_as_opencvs():
    levels = smooth_picture(480, 640, 3)
    settings = (cv2.IMWRITE_PNG_COMPRESSION, 1, cv2.IMWRITE_PNG_STRATEGY, 3)
    _, content = cv2.imencode(".png", levels[..., ::-1], settings)
    assert len(png_file(levels)) < 1.1 * len(content)


def test_a_view_of_a_picture_is_written_like_a_copy():
    levels = smooth_picture(40, 60, 3)
    assert png_file(levels[5:, ::2, ::-1]) == png_file(levels[5:, ::2, ::-1].copy())
