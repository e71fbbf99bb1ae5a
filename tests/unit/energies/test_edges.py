import numpy as np
import pytest

from fitter.energies.edges import edge_cost_map


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
