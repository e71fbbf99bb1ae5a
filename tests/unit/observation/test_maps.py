import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.ndimage import distance_transform_edt

from fitter.observation.maps import exact_distances, sample, window_about


@pytest.mark.parametrize("margin", [0, 1, 30])
def test_a_window_holds_what_is_marked_and_a_margin_within_the_picture(margin):
    marked = np.zeros((20, 30), dtype=np.bool_)
    marked[4, 7] = marked[9, 12] = True
    window = window_about(marked, margin=margin)
    assert marked[window].sum() == 2
    rows, columns = np.arange(20)[window[0]], np.arange(30)[window[1]]
    assert (rows[0], rows[-1]) == (max(4 - margin, 0), min(9 + margin, 19))
    assert (columns[0], columns[-1]) == (max(7 - margin, 0), min(12 + margin, 29))


def test_distances_are_the_exact_ones_to_the_last_bit():
    rng = np.random.default_rng(4)
    elsewhere = (rng.random((700, 900)) > 0.0005).astype(np.uint8)
    rows, columns = distance_transform_edt(
        elsewhere, return_distances=False, return_indices=True
    ).astype(np.int64)
    here = np.indices(elsewhere.shape)
    squared = (rows - here[0]) ** 2 + (columns - here[1]) ** 2
    np.testing.assert_array_equal(
        exact_distances(elsewhere), np.sqrt(squared.astype(np.float32)), strict=True
    )


def test_the_longest_distance_of_a_working_picture_is_exact_too():
    elsewhere = np.ones((1600, 1200), dtype=np.uint8)
    elsewhere[0, 0] = 0
    assert exact_distances(elsewhere)[-1, -1] == np.sqrt(np.float32(1599**2 + 1199**2))


def test_with_nothing_to_be_near_to_every_distance_is_far():
    assert (exact_distances(np.ones((30, 40), dtype=np.uint8)) > 1000.0).all()


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
