"""What is known of the shape, in closed form and against finite differences."""

import csv

import numpy as np
import pytest

from fitter.energies.shape_terms import (
    HEIGHT_CURVATURE,
    POPULATION_PRECISION,
    USUAL_HEIGHT_SD,
    ShapePrior,
    height_extrapolation,
    population_prior,
)
from fitter.fits.equipment import prepared_model
from fitter.training.report.survey_comparison import load_moments, packaged_moments_path
from fitter.vocabulary.choices import Gender
from fitter.vocabulary.measurements import STATURE
from tests.shared_data import SHARED_DATA, needs_shared

SURVEY = SHARED_DATA / "anthropometry"

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


def test_variance_grows_by_the_square_of_how_far_a_bent_line_leaves_a_straight_one():
    assert height_extrapolation(7.0) == pytest.approx(1.0 + (48.0 * HEIGHT_CURVATURE) ** 2)
    assert height_extrapolation(-7.0) == height_extrapolation(7.0)
    assert height_extrapolation(USUAL_HEIGHT_SD) == 1.0
    assert 1.0 < height_extrapolation(1.001 * USUAL_HEIGHT_SD) < 1.05


def curvature_on_the_height(gender: Gender) -> float:
    """Root mean square of the survey's fields, in the heights' deviations of our model."""
    fields = load_moments(packaged_moments_path(), gender.value).names
    path = SURVEY / f"ANSUR_II_{gender.value.upper()}_Public.csv"
    with path.open(encoding="latin-1", newline="") as stream:
        people = list(csv.DictReader(stream))
    values = np.array([[float(person[name]) for name in fields] for person in people]) / 10.0
    at = fields.index("stature")
    population = prepared_model(gender).population
    slope = population.shapes.jacobian_at_mean[population.names.index(STATURE)]
    height = (values[:, at] - values[:, at].mean()) / np.linalg.norm(slope)
    line = np.stack([np.ones_like(height), height], axis=1)
    others = np.delete(values, at, axis=1)
    scatter = (others - line @ np.linalg.lstsq(line, others)[0]).std(axis=0)
    bent = np.column_stack([line, height**2 - 1.0])
    return float(np.sqrt(np.mean((np.linalg.lstsq(bent, others)[0][2] / scatter) ** 2)))


@needs_shared(SURVEY)
def test_the_curvature_is_that_of_surveyed_men_and_no_less_than_that_of_women():
    women, men = (curvature_on_the_height(gender) for gender in (Gender.FEMALE, Gender.MALE))
    assert men == pytest.approx(HEIGHT_CURVATURE, rel=0.02)
    assert 0.5 * HEIGHT_CURVATURE < women < HEIGHT_CURVATURE
