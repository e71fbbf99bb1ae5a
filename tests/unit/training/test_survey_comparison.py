import numpy as np
import pytest

from fitter.body.storage import load_body_model, packaged_model_path
from fitter.measurement.definition_file import load_definitions
from fitter.training.report.survey_comparison import (
    Moments,
    comparison_lines,
    drawn_measurements,
    effective_count,
    matching_weights,
    survey_comparison,
    weighted_moments,
)
from fitter.training.surveys.survey_moments import load_moments, packaged_moments_path

DEFINITIONS = load_definitions()
OTHER_THAN_THE_SURVEYS = {"ankle_height"}
"""The mesh's outer ankle is no ankle bone."""

SURVEYED = [definition for definition in DEFINITIONS if definition.about.survey.fields]


def soldiers(gender: str, count: int) -> np.ndarray:
    """People of the survey, log-normal, measured exactly as the survey does."""
    moments = load_moments(packaged_moments_path(), gender)
    surveys = [definition.about.survey for definition in SURVEYED]
    mean, covariance = moments.of([dict.fromkeys(each.fields, each.share) for each in surveys])
    logarithms = np.log1p(covariance / np.outer(mean, mean))
    drawn = np.random.default_rng(0).multivariate_normal(
        np.log(mean) - 0.5 * np.diagonal(logarithms),
        logarithms,
        count,
        # An arm's length is the sum of its parts': rounding leaves eigenvalues below zero.
        check_valid="ignore",
        method="eigh",
    )
    return np.exp(drawn)


@pytest.mark.parametrize("gender", ["female", "male"])
def test_people_of_the_survey_itself_do_not_differ_from_it(gender: str):
    figures = survey_comparison(gender, SURVEYED, soldiers(gender, 5000))
    assert np.abs(figures.mean_differences).max() < 0.05
    np.testing.assert_allclose(figures.people.deviation / figures.survey.deviation, 1.0, atol=0.05)
    assert figures.effective_count > 4900
    assert np.abs(figures.correlation_differences).mean() < 0.02


def test_heavier_people_are_weighted_to_the_surveys_weights():
    values = soldiers("male", 5000)
    names = [definition.about.name for definition in SURVEYED]
    # Girths as the survey's people have them, but twice as many of the heavy half.
    weight = values[:, names.index("weight")]
    heavier = np.concatenate([values, values[weight > np.median(weight)]])
    figures = survey_comparison("male", SURVEYED, heavier)
    waist = names.index("waist_girth_navel")
    assert (
        heavier[:, waist].mean() - figures.survey.mean[waist]
        > 0.2 * figures.survey.deviation[waist]
    )
    assert abs(figures.mean_differences[waist]) < 0.1
    assert figures.effective_count < 0.98 * len(heavier)


def test_a_definition_that_measures_elsewhere_shows():
    values = soldiers("female", 3000)
    names = [definition.about.name for definition in SURVEYED]
    hip = names.index("hip_girth")
    values[:, hip] += 2.0
    figures = survey_comparison("female", SURVEYED, values)
    assert figures.mean_differences[hip] == pytest.approx(2.0 / 7.59, abs=0.05)


@pytest.mark.parametrize("gender", ["female", "male"])
def test_the_shipped_models_people_measure_as_the_surveys_do(gender: str):
    model = load_body_model(packaged_model_path(gender))
    drawn = drawn_measurements(model, count=250, seed=2)
    figures = survey_comparison(gender, DEFINITIONS, drawn)
    assert figures.effective_count > 50
    comparable = [name not in OTHER_THAN_THE_SURVEYS for name in figures.names]
    assert np.abs(figures.mean_differences[comparable]).max() < 1.2, figures.names
    assert np.abs(figures.mean_differences).mean() < 0.35
    quotients = figures.people.deviation / figures.survey.deviation
    assert 0.35 < quotients.min() < quotients.max() < 1.4
    assert np.abs(figures.correlation_differences).mean() < 0.15
    lines = comparison_lines(figures)
    assert len(lines) > len(figures.names)


def test_flexed_arms_are_compared_by_their_share():
    figures = survey_comparison("male", SURVEYED, soldiers("male", 500))
    moments = load_moments(packaged_moments_path(), "male")
    flexed = moments.mean[moments.names.index("bicepscircumferenceflexed")]
    arm = figures.names.index("upper_arm_girth")
    assert figures.survey.mean[arm] == pytest.approx(0.93 * flexed)
    assert "waist_girth_smallest" not in figures.names


TARGET = Moments(mean=np.array([0.5, -0.2]), covariance=np.array([[0.5, 0.1], [0.1, 0.4]]))


def people(count: int = 4000) -> np.ndarray:
    return np.random.default_rng(0).multivariate_normal([0.0, 0.0], [[1.0, 0.3], [0.3, 1.0]], count)


def test_weighted_gaussian_people_have_the_targets_mean_and_covariance():
    weights = matching_weights(people(40_000), TARGET)
    mean, covariance = weighted_moments(people(40_000), weights)
    np.testing.assert_allclose(mean, TARGET.mean, atol=0.02)
    np.testing.assert_allclose(covariance, TARGET.covariance, atol=0.02)
    assert weights.sum() == pytest.approx(1.0)


def test_people_who_are_the_target_already_keep_equal_weights():
    given = people()
    own = Moments(mean=given.mean(axis=0), covariance=np.cov(given.T, bias=True))
    weights = matching_weights(given, own)
    np.testing.assert_allclose(weights, 1.0 / len(given), rtol=1e-6)
    assert effective_count(weights) == pytest.approx(len(given))
