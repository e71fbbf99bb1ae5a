import numpy as np
from scipy.special import logsumexp

from fitter.segmentation._mixture_kernels import likeliest_components
from fitter.segmentation.colour_mixture import (
    ROUNDING_VARIANCE,
    ColourMixture,
    first_mixture,
    relearnt_mixture,
)
from tests.unit.segmentation.plain_grabcut import plain_costs

CENTRES = np.array(
    [[30, 40, 50], [200, 60, 40], [60, 190, 80], [90, 80, 220], [230, 225, 210]], dtype=np.float64
)
SHARES = np.array([0.3, 0.25, 0.2, 0.15, 0.1])


def colours(*, spread: float, count: int = 4000) -> tuple[np.ndarray, np.ndarray]:
    """Colours round five centres, and whose each is."""
    random = np.random.default_rng(0)
    whose = np.repeat(np.arange(5), (count * SHARES).astype(int))
    stretch = random.normal(size=(5, 3, 3))
    noise = np.einsum("sij,sj->si", stretch[whose], random.normal(size=(len(whose), 3)))
    return (CENTRES[whose] + spread * noise).astype(np.float32), whose


def test_the_costs_are_minus_the_logarithm_of_the_density():
    sample, _ = colours(spread=25.0)
    mixture = first_mixture(sample)
    np.testing.assert_allclose(
        mixture.costs(sample), plain_costs(mixture, sample.astype(np.float64)), atol=2e-3
    )


def test_far_from_all_components_the_cost_stays_finite_and_the_nearest_tells():
    mixture = ColourMixture(
        weights=np.array([0.5, 0.5]),
        means=np.array([[0.0, 0.0, 0.0], [20.0, 0.0, 0.0]]),
        covariances=np.repeat(np.eye(3)[None], 2, axis=0),
    )
    far = np.array([[255.0, 0.0, 0.0]], dtype=np.float32)
    np.testing.assert_allclose(mixture.costs(far), 0.5 * 235.0**2 + np.log(2.0), rtol=1e-6)


def test_well_separated_colours_are_told_apart_from_the_start():
    sample, whose = colours(spread=3.0)
    mixture = first_mixture(sample)
    order = np.argsort(-mixture.weights)
    np.testing.assert_allclose(mixture.weights[order], SHARES, atol=1e-12)
    for component, k in zip(order, range(5), strict=True):
        own = sample[whose == k].astype(np.float64)
        np.testing.assert_allclose(mixture.means[component], own.mean(axis=0), atol=1e-6)
        expected = np.cov(own.T, bias=True) + ROUNDING_VARIANCE * np.eye(3)
        np.testing.assert_allclose(mixture.covariances[component], expected, atol=1e-6)


def test_learning_again_never_makes_the_colours_less_likely_to_their_components():
    sample, _ = colours(spread=40.0)
    mixture = first_mixture(sample)
    costs = [mixture.costs(sample).astype(np.float64).mean()]
    for _ in range(5):
        mixture = relearnt_mixture(mixture, sample)
        costs.append(mixture.costs(sample).astype(np.float64).mean())
    assert costs[-1] < costs[0]


def test_a_component_that_is_nobodys_likeliest_is_dropped():
    sample, whose = colours(spread=3.0)
    mixture = relearnt_mixture(first_mixture(sample), sample[whose < 4])
    assert len(mixture.weights) == 4
    np.testing.assert_allclose(mixture.weights.sum(), 1.0)


def test_one_colour_is_one_component():
    grey = np.full((50, 3), 128.0, dtype=np.float32)
    mixture = first_mixture(grey)
    assert len(mixture.weights) == 1
    assert np.isfinite(mixture.costs(grey)).all()
    np.testing.assert_allclose(mixture.covariances[0], ROUNDING_VARIANCE * np.eye(3), atol=1e-9)


def test_compiled_costs_and_choices_are_those_of_whole_arrays():
    rng = np.random.default_rng(8)
    colours = rng.uniform(0.0, 255.0, (700, 3)).astype(np.float32)
    mixture = first_mixture(colours)
    factors = np.linalg.cholesky(np.linalg.inv(mixture.covariances)).swapaxes(1, 2)
    offsets = -np.log(mixture.weights) + 0.5 * np.linalg.slogdet(mixture.covariances)[1]
    away = np.einsum("kij,skj->ski", factors, colours[:, None] - mixture.means)
    costs = offsets + 0.5 * (away**2).sum(axis=2)
    expected = -logsumexp(-costs, axis=1)
    np.testing.assert_allclose(mixture.costs(colours), expected, atol=2e-4)
    rows = np.column_stack([offsets, mixture.means, factors[:, *np.triu_indices(3)]])
    chosen = likeliest_components(colours, rows.astype(np.float32))
    sure = np.diff(np.sort(costs, axis=1)[:, :2], axis=1)[:, 0] > 1e-2
    np.testing.assert_array_equal(chosen[sure], costs.argmin(axis=1)[sure])
