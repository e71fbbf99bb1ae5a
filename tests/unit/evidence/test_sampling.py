import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from fitter.evidence.sampling import sample

VALUES = np.random.default_rng(0).random((12, 15)).astype(np.float32)


def test_pixel_centres_return_their_pixels():
    rows, columns = np.mgrid[:12, :15]
    points = np.stack([columns.ravel() + 0.5, rows.ravel() + 0.5], axis=1)
    np.testing.assert_allclose(sample(VALUES, points)[0], VALUES.ravel(), rtol=1e-6)


def test_a_plane_is_reproduced_with_its_slope():
    rows, columns = np.mgrid[:12, :15] + 0.5
    points = np.random.default_rng(1).uniform([0.5, 0.5], [14.5, 11.5], (50, 2))
    values, slopes = sample((2.0 * columns - 3.0 * rows).astype(np.float32), points)
    np.testing.assert_allclose(values, points @ [2.0, -3.0], atol=1e-4)
    np.testing.assert_allclose(slopes, np.broadcast_to([2.0, -3.0], (50, 2)), atol=1e-4)


@given(x=st.floats(-5, 20), y=st.floats(-5, 17))
def test_slopes_match_finite_differences_inside_a_cell_and_beyond_the_border(x: float, y: float):
    step = 1e-3
    # The interpolation has kinks at pixel centres: keep the difference within one cell.
    point = np.array([[np.floor(x) + 0.5, np.floor(y) + 0.5]]) + np.clip(
        [x % 1, y % 1], 2 * step, 1 - 2 * step
    )
    _, slopes = sample(VALUES.astype(np.float64), point)
    for axis in range(2):
        offset = step * np.eye(2)[axis]
        after, _ = sample(VALUES.astype(np.float64), point + offset)
        before, _ = sample(VALUES.astype(np.float64), point - offset)
        np.testing.assert_allclose(slopes[:, axis], (after - before) / (2 * step), atol=1e-9)


def test_beyond_the_border_the_map_goes_on_unchanged():
    points = np.array([[-50.0, 6.5], [80.0, 6.5], [7.5, -9.0], [7.5, 40.0]])
    values, _ = sample(VALUES, points)
    expected = [VALUES[6, 0], VALUES[6, -1], VALUES[0, 7], VALUES[-1, 7]]
    np.testing.assert_allclose(values, expected, rtol=1e-6)
