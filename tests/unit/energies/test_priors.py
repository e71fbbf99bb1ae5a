"""What is known of the shape, in closed form and against finite differences."""

import numpy as np
import pytest

from fitter.energies.priors import POPULATION_PRECISION, ShapePrior, population_prior

N = 6


@pytest.fixture
def told() -> ShapePrior:
    """What other pictures may say of somebody."""
    rng = np.random.default_rng(3)
    root = rng.standard_normal((N, N))
    root[0] = 0.0
    return ShapePrior(mean=rng.standard_normal(N), precision=root @ root.T)


def test_the_population_is_wider_than_standard_normal_but_for_the_height():
    shape = np.array([5.0, 1.0, -2.0, 0.0, 3.0, 0.5])
    prior = population_prior(N)
    standard = 0.5 * (1.0 + 4.0 + 9.0 + 0.25)
    assert prior.energy(shape) == pytest.approx(POPULATION_PRECISION * standard)
    np.testing.assert_allclose(prior.slope(shape), POPULATION_PRECISION * shape * (shape != 5.0))


def test_the_energy_is_least_at_the_mean(told):
    assert told.energy(told.mean) == 0.0
    shape = told.mean + np.array([0.0, 0.3, -0.1, 0.2, 0.0, 0.4])
    assert told.energy(shape) == pytest.approx(
        0.5 * (shape - told.mean) @ told.precision @ (shape - told.mean)
    )


def test_the_height_changes_nothing(told):
    shape = np.linspace(-1.0, 1.0, N)
    assert told.energy(shape + 7.0 * np.eye(N)[0]) == told.energy(shape)
    assert told.slope(shape)[0] == 0.0


def test_the_slope_is_the_energy_s_derivative(told):
    shape, step = np.linspace(-1.0, 1.0, N), 1e-5
    numeric = [
        (told.energy(shape + step * axis) - told.energy(shape - step * axis)) / (2.0 * step)
        for axis in np.eye(N)
    ]
    np.testing.assert_allclose(told.slope(shape), numeric, atol=1e-7)
