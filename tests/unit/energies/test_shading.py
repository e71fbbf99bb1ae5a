import numpy as np

from fitter.energies.shading import IntensityMap, intensity_map

MASK = np.zeros((60, 80), dtype=np.bool_)
MASK[15:45, 20:60] = True


def grey(value: float) -> np.ndarray:
    return np.full((60, 80, 3), value, dtype=np.float32)


def prepared(luminance: np.ndarray) -> IntensityMap:
    return intensity_map(luminance.astype(np.float32), grey(0.5), MASK)


def test_the_background_never_bleeds_into_the_person():
    evidence = prepared(np.where(MASK, 0.3, 50.0))
    np.testing.assert_allclose(evidence.luminance[MASK], 0.3, rtol=1e-5)


def test_noise_is_smoothed_within_the_person():
    noise = np.random.default_rng(0).normal(0.5, 0.1, MASK.shape)
    evidence = prepared(noise)
    core = np.s_[22:38, 27:53]
    assert evidence.luminance[core].std() < 0.4 * noise[core].std()


def test_pixels_on_the_rim_are_not_trusted():
    evidence = prepared(np.full(MASK.shape, 0.5))
    assert not evidence.trusted[~MASK].any()
    assert not evidence.trusted[15:18, 20:60].any()
    assert evidence.trusted[20:40, 25:55].all()


def test_clipped_pixels_of_any_channel_are_not_trusted():
    display = grey(0.5)
    display[30, 40] = [0.5, 1.0, 0.5]
    evidence = intensity_map(np.full(MASK.shape, 0.5, dtype=np.float32), display, MASK)
    assert not evidence.trusted[30, 40]
    assert evidence.trusted[30, 42]


def test_samples_carry_value_slope_and_trust():
    columns = np.mgrid[:60, :80][1] + 0.5
    evidence = prepared(0.01 * columns)
    points = np.array([[40.2, 30.7], [22.0, 30.0], [5.0, 5.0]])
    values, slopes = evidence.with_gradient_at(points[:1])
    np.testing.assert_allclose(values, evidence.at(points[:1]))
    np.testing.assert_allclose(values, 0.402, atol=1e-4)
    np.testing.assert_allclose(slopes, [[0.01, 0.0]], atol=1e-5)
    np.testing.assert_array_equal(evidence.trusted_at(points), [True, False, False])


def test_points_beyond_the_border_take_the_nearest_pixels_trust():
    evidence = prepared(np.full(MASK.shape, 0.5))
    assert not evidence.trusted_at(np.array([[-3.0, 500.0]]))[0]
