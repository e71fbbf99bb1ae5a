import numpy as np
from scipy.ndimage import distance_transform_edt

from fitter.numerics.masks import exact_distances


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
