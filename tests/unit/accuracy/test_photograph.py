import io

import numpy as np
from PIL import Image as PillowImage

from fitter.observation.picture_files import read_exif
from fitter.observation.pixels import linear_from_display
from tests.accuracy.photograph import photograph


def _taken(linear: np.ndarray, equivalent_mm: int | None = None) -> PillowImage.Image:
    data = photograph(
        linear, quality=100, equivalent_mm=equivalent_mm, rng=np.random.default_rng(0)
    )
    return PillowImage.open(io.BytesIO(data))


def test_noise_and_compression_leave_mean_light_as_it_was():
    linear = np.tile(np.array([0.05, 0.2, 0.7]), (64, 64, 1))
    display = np.asarray(_taken(linear), dtype=float) / 255.0
    np.testing.assert_allclose(
        linear_from_display(display).mean(axis=(0, 1)), linear[0, 0], rtol=0.02
    )


def test_bright_light_is_noisier_than_dark_in_linear_light():
    dark, bright = (np.full((64, 64, 3), level) for level in (0.02, 0.6))
    deviations = [
        linear_from_display(np.asarray(_taken(light), dtype=float) / 255.0).std()
        for light in (dark, bright)
    ]
    assert deviations[1] > 2.0 * deviations[0]


def test_the_focal_length_is_in_the_file_where_it_is_meant_to_be():
    grey = np.full((8, 8, 3), 0.2)
    assert read_exif(_taken(grey, equivalent_mm=50)).focal_length_35mm == 50.0
    assert read_exif(_taken(grey)).focal_length_35mm is None
