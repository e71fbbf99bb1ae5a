import re

import numpy as np
import pytest

from fitter.body.storage import load_body_model, packaged_model_path
from fitter.measurement.definition_file import load_definitions
from fitter.training.report.measured_people import drawn_measurements
from fitter.training.report.measurement_figures import measurement_figures
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
    figures = measurement_figures(gender, SURVEYED, soldiers(gender, 5000))
    assert np.abs(figures.mean_differences).max() < 0.05
    np.testing.assert_allclose(figures.deviation_quotients, 1.0, atol=0.05)
    assert figures.effective_count > 4900
    assert figures.mean_correlation_difference < 0.02
    assert 0.005 < figures.chance_correlation_difference < 0.02


def test_heavier_people_are_weighted_to_the_surveys_weights():
    values = soldiers("male", 5000)
    names = [definition.about.name for definition in SURVEYED]
    # Girths as the survey's people have them, but twice as many of the heavy half.
    weight = values[:, names.index("weight")]
    heavier = np.concatenate([values, values[weight > np.median(weight)]])
    figures = measurement_figures("male", SURVEYED, heavier)
    waist = names.index("waist_girth_navel")
    plain = figures.plain.mean[waist] - figures.survey.mean[waist]
    assert plain > 0.2 * figures.survey.deviation[waist]
    assert abs(figures.mean_differences[waist]) < 0.05
    assert figures.effective_count < 0.98 * len(heavier)


def test_a_definition_that_measures_elsewhere_shows():
    values = soldiers("female", 3000)
    names = [definition.about.name for definition in SURVEYED]
    hip, neck = names.index("hip_girth"), names.index("neck_girth")
    values[:, hip] += 2.0
    values[:, neck] = np.random.default_rng(1).permutation(values[:, neck])
    figures = measurement_figures("female", SURVEYED, values)
    assert figures.mean_differences[hip] == pytest.approx(2.0 / 7.59, abs=0.05)
    assert "neck_girth" in figures.worst_pair


@pytest.mark.parametrize("gender", ["female", "male"])
def test_the_shipped_models_people_measure_as_the_surveys_do(gender: str):
    model = load_body_model(packaged_model_path(gender))
    drawn = drawn_measurements(model, 250, np.random.default_rng(2))
    figures = measurement_figures(gender, DEFINITIONS, drawn)
    assert figures.effective_count > 50
    comparable = [name not in OTHER_THAN_THE_SURVEYS for name in figures.names]
    assert np.abs(figures.mean_differences[comparable]).max() < 1.2, figures.names
    assert np.abs(figures.mean_differences).mean() < 0.35
    assert 0.35 < figures.deviation_quotients.min() < figures.deviation_quotients.max() < 1.4
    assert figures.mean_correlation_difference < 0.15


def test_flexed_arms_are_compared_by_their_share():
    figures = measurement_figures("male", SURVEYED, soldiers("male", 500))
    moments = load_moments(packaged_moments_path(), "male")
    flexed = moments.mean[moments.names.index("bicepscircumferenceflexed")]
    arm = figures.names.index("upper_arm_girth")
    assert figures.survey.mean[arm] == pytest.approx(0.93 * flexed)
    assert not re.search("waist_girth_smallest", " ".join(figures.names))
