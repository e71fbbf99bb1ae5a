"""Terms of the picture: edges, clicked points, shading."""

import numpy as np
import pytest

from fitter.energies.edges import edge_cost_map
from fitter.energies.landmarks import SlantEvidence, slant_energy, slant_rows
from fitter.energies.shading import IntensityMap, intensity_map
from fitter.pose_init.limbs import TRUNCATION


def step_picture(*, dark: float = 0.2, bright: float = 0.8, column: int = 50) -> np.ndarray:
    display = np.full((80, 100, 3), dark, dtype=np.float32)
    display[:, column:] = bright
    return display


def test_cost_rises_linearly_from_an_edge_to_one_at_the_threshold():
    edges = edge_cost_map(step_picture(), threshold_px=12)
    offsets = np.arange(2, 12)
    cost = edges.at(np.stack([50.0 + offsets, np.full(10, 40.5)], axis=1))
    np.testing.assert_allclose(np.diff(cost), 1 / 12, atol=0.01)
    np.testing.assert_allclose(cost, offsets / 12, atol=0.6 / 12)
    far = edges.at(np.array([[90.0, 40.0], [10.0, 40.0]]))
    np.testing.assert_array_equal(far, 1.0)


def test_cost_lies_between_zero_and_one():
    noise = np.random.default_rng(0).random((80, 100, 3)).astype(np.float32)
    cost = edge_cost_map(noise, threshold_px=8).cost
    assert cost.min() == 0.0
    assert cost.max() <= 1.0


def test_a_picture_without_edges_costs_one_everywhere():
    np.testing.assert_array_equal(
        edge_cost_map(np.full((40, 50, 3), 0.5, dtype=np.float32), threshold_px=8).cost, 1.0
    )


def test_edges_are_found_in_colour_by_its_lightness_and_weak_ones_passed_over():
    weak = edge_cost_map(step_picture(dark=0.5, bright=0.505), threshold_px=8)
    np.testing.assert_array_equal(weak.cost, 1.0)
    skin_on_skin = edge_cost_map(step_picture(dark=0.55, bright=0.7), threshold_px=8)
    assert skin_on_skin.cost.min() == 0.0


@pytest.mark.parametrize("x", [44.3, 47.8, 53.2, 57.7])
def test_gradient_points_away_from_the_edge(x: float):
    edges = edge_cost_map(step_picture(), threshold_px=12)
    cost, gradient = edges.with_gradient_at(np.array([[x, 40.3]]))
    assert 0 < cost[0] < 1
    np.testing.assert_allclose(gradient[0], [np.sign(x - 50) / 12, 0], atol=0.01)


def test_turning_the_picture_turns_the_cost():
    noise = np.random.default_rng(1).random((64, 64, 3)).astype(np.float32)
    smooth = np.kron(noise[:8, :8], np.ones((8, 8, 1), dtype=np.float32))
    turned = edge_cost_map(np.ascontiguousarray(smooth[::-1]), threshold_px=10).cost
    straight = edge_cost_map(smooth, threshold_px=10).cost
    # Canny breaks ties between equal neighbours by scan order: edges may shift by a pixel.
    assert np.abs(turned[::-1] - straight).mean() < 0.1


TOWARD = np.array([0.28, 0.0, 0.96])
LANDMARKS = np.array([[0.0, 0.0, 3.0], [0.1, 0.4, 3.2], [0.0, 0.8, 3.1]])


def evidence(reach_m: float, *, sigma_m: float = 0.05) -> SlantEvidence:
    """Of the limb from the first landmark to the second."""
    return SlantEvidence(
        ends=np.array([[0, 1]]),
        toward=TOWARD,
        reach_m=np.array([reach_m]),
        sigma_m=np.array([sigma_m]),
    )


def true_reach() -> float:
    return float((LANDMARKS[1] - LANDMARKS[0]) @ TOWARD)


def test_a_limb_that_reaches_as_told_costs_nothing():
    assert slant_energy(LANDMARKS, evidence(true_reach())) == pytest.approx(0.0, abs=1e-12)


def test_near_what_was_told_the_energy_is_half_a_square():
    assert slant_energy(LANDMARKS, evidence(true_reach() - 0.05)) == pytest.approx(0.5)


def test_far_from_it_the_energy_grows_linearly():
    near, far = (slant_energy(LANDMARKS, evidence(true_reach() - d)) for d in (0.5, 0.6))
    assert far - near == pytest.approx(TRUNCATION * 0.1 / 0.05)


@pytest.mark.parametrize("reach", [0.17, 0.5])
def test_rows_are_the_energys_gradient(reach):
    told = evidence(reach)
    rows = slant_rows(LANDMARKS, told)
    gradient = np.zeros_like(LANDMARKS)
    for weight, residual, points, derivatives in zip(
        rows.weights, rows.residuals, rows.points, rows.derivatives, strict=True
    ):
        np.add.at(gradient, points, weight * residual * derivatives)
    for index in np.ndindex(LANDMARKS.shape):
        step = np.zeros_like(LANDMARKS)
        step[index] = 1e-6
        slope = slant_energy(LANDMARKS + step, told) - slant_energy(LANDMARKS - step, told)
        assert gradient[index] == pytest.approx(slope / 2e-6, abs=1e-4)


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
