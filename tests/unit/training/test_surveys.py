"""Surveys: what is packaged of them, people drawn from them, and the model's beside them."""

import csv

import numpy as np
import pytest

from fitter.body.storage import load_body_model, packaged_model_path
from fitter.measurement.definitions import load_definitions
from fitter.training.report.survey_comparison import (
    Moments,
    comparison_lines,
    drawn_measurements,
    effective_count,
    load_moments,
    matching_weights,
    packaged_moments_path,
    survey_comparison,
    weighted_moments,
)
from fitter.training.surveys.survey import (
    AGES,
    BMI_RANGE,
    RELAXED_SHARE,
    Civilian,
    draw_civilian,
    draw_measurements,
    load_civilians,
    load_statistics,
    on_the_model,
    packaged_civilians_path,
    packaged_statistics_path,
    regression,
)
from fitter.training.surveys.survey_measurements import MEASUREMENTS
from tests.shared_data import SHARED_DATA, needs_shared

GENDERS = ("female", "male")


@pytest.mark.parametrize("gender", GENDERS)
def test_packaged_statistics_cover_what_the_model_measures(gender: str):
    statistics = load_statistics(packaged_statistics_path(), gender)
    assert statistics.names == MEASUREMENTS
    assert statistics.count == {"female": 1986, "male": 4082}[gender]
    assert np.linalg.eigvalsh(statistics.log_covariance).min() > 0.0
    stature = statistics.median[statistics.names.index("stature")]
    assert stature == pytest.approx({"female": 1.627, "male": 1.755}[gender], abs=0.002)


@pytest.mark.parametrize("gender", GENDERS)
def test_the_surveys_regression_foretells_civilian_waists_at_every_age(gender: str):
    civilians = load_civilians(packaged_civilians_path(), gender)
    found = regression(load_statistics(packaged_statistics_path(), gender))
    waist = MEASUREMENTS.index("waistcircumference")
    given = np.stack(
        [civilians.log_stature, civilians.log_bmi + 2.0 * civilians.log_stature, civilians.age]
    )
    expected = found.log_mean[waist] + found.slope[:, waist] @ (given - found.given_mean[:, None])
    assert np.abs(civilians.log_waist - expected).max() < 0.03


def test_a_drawn_subject_keeps_stature_and_weight_and_varies_about_the_regression():
    statistics = load_statistics(packaged_statistics_path(), "female")
    found = regression(statistics)
    generator = np.random.default_rng(1)
    person = Civilian(age=70.0, stature=1.6, weight=80.0)
    drawn = np.log([draw_measurements(statistics, person, generator) for _ in range(4000)])
    given = [MEASUREMENTS.index(name) for name in ("stature", "weightkg")]
    np.testing.assert_allclose(drawn[:, given], np.log([[1.6, 80.0]]).repeat(4000, 0))
    others = [k for k in range(len(MEASUREMENTS)) if k not in given]
    expected = found.residual_covariance[np.ix_(others, others)]
    scale = np.sqrt(np.outer(np.diagonal(expected), np.diagonal(expected)))
    assert np.abs((np.cov(drawn[:, others].T) - expected) / scale).max() < 0.08
    deviation = (drawn.mean(axis=0) - found.expected(person))[others]
    assert np.abs(deviation / np.sqrt(np.diagonal(expected))).max() < 0.08


def test_older_people_of_one_weight_have_wider_waists_and_thinner_thighs():
    found = regression(load_statistics(packaged_statistics_path(), "male"))
    young, old = (
        found.expected(Civilian(age=age, stature=1.75, weight=85.0)) for age in (25.0, 75.0)
    )
    change = dict(zip(MEASUREMENTS, np.expm1(old - young), strict=True))
    assert change["waistcircumference"] > 0.05
    assert change["thighcircumference"] < 0.0


def test_definitions_that_agree_are_left_as_surveyed():
    surveyed = np.ones(len(MEASUREMENTS))
    on_model = on_the_model(MEASUREMENTS, "female", surveyed)
    assert on_model[MEASUREMENTS.index("waistcircumference")] == 1.0
    assert on_model[MEASUREMENTS.index("hipbreadth")] == pytest.approx(1.058)
    assert on_model[MEASUREMENTS.index("acromialheight")] == pytest.approx(1.010)


@pytest.mark.parametrize("gender", GENDERS)
def test_packaged_civilians_are_those_of_the_survey(gender: str):
    civilians = load_civilians(packaged_civilians_path(), gender)
    assert civilians.count.sum() == {"female": 2647, "male": 2528}[gender]
    assert (np.diff(civilians.age) > 0.0).all()
    # Old people have shrunk, and weigh least at either end of adult life.
    assert civilians.log_stature[-1] < civilians.log_stature[1] - 0.02
    assert civilians.log_bmi[2:5].min() > civilians.log_bmi[[0, -1]].max()
    assert np.linalg.eigvalsh(civilians.log_covariance).min() > 0.0


@pytest.mark.parametrize("gender", GENDERS)
def test_drawn_civilians_are_adults_of_every_age_and_build(gender: str):
    civilians = load_civilians(packaged_civilians_path(), gender)
    generator = np.random.default_rng(0)
    drawn = [draw_civilian(civilians, generator) for _ in range(4_000)]
    age = np.array([person.age for person in drawn])
    stature = np.array([person.stature for person in drawn])
    index = np.array([person.weight for person in drawn]) / stature**2
    assert BMI_RANGE[0] <= index.min() < BMI_RANGE[0] + 0.5
    assert BMI_RANGE[1] - 0.5 < index.max() <= BMI_RANGE[1]
    np.testing.assert_allclose(
        np.percentile(age, [25, 75]), np.quantile(AGES, [0.25, 0.75]), atol=1
    )
    middle = (age > 45.0) & (age < 55.0)
    k = int(np.argmin(np.abs(civilians.age - 50.0)))
    assert np.log(stature[middle]).mean() == pytest.approx(civilians.log_stature[k], abs=0.004)
    # Redrawn tails cost the mean of the index less than a tenth of its spread.
    spread = np.sqrt(civilians.log_covariance[k, 1, 1])
    assert np.log(index[middle]).mean() == pytest.approx(civilians.log_bmi[k], abs=0.2 * spread)


SURVEY = SHARED_DATA / "anthropometry"


def source_name(name: str) -> str:
    """The survey's name of a field of the statistics: its arms are flexed."""
    return f"{name}flexed" if name in RELAXED_SHARE else name


def surveyed(gender: str, names: tuple[str, ...]) -> np.ndarray:
    """Fields of everybody in the public release; centimetres, kilograms, years."""
    path = SURVEY / f"ANSUR_II_{gender.upper()}_Public.csv"
    with path.open(encoding="latin-1", newline="") as stream:
        people = list(csv.DictReader(stream))
    units = np.array([1.0 if name == "Age" else 10.0 for name in names])
    return np.array([[float(person[name]) for name in names] for person in people]) / units


@needs_shared(SURVEY)
@pytest.mark.parametrize("gender", GENDERS)
def test_the_packaged_moments_are_those_of_the_public_release(gender: str):
    moments = load_moments(packaged_moments_path(), gender)
    values = surveyed(gender, moments.names)
    assert moments.count == len(values)
    np.testing.assert_allclose(moments.mean, values.mean(axis=0), atol=1e-4)
    np.testing.assert_allclose(moments.covariance, np.cov(values.T), atol=1e-5)


@needs_shared(SURVEY)
@pytest.mark.parametrize("gender", GENDERS)
def test_the_packaged_statistics_are_those_of_the_public_release(gender: str):
    found = load_statistics(packaged_statistics_path(), gender)
    values = surveyed(gender, (*(source_name(name) for name in found.names), "Age"))
    shares = [RELAXED_SHARE.get(name, 1.0) for name in found.names]
    metres = [1.0 if name == "weightkg" else 100.0 for name in found.names]
    logarithms = np.log(values[:, :-1] * shares / metres)
    covariance = np.cov(np.column_stack([logarithms, values[:, -1]]).T)
    np.testing.assert_allclose(found.log_mean, logarithms.mean(axis=0), atol=1e-6)
    np.testing.assert_allclose(found.log_covariance, covariance[:-1, :-1], atol=1e-8)
    np.testing.assert_allclose(found.age_covariance, covariance[-1, :-1], atol=1e-6)
    assert found.age_mean == pytest.approx(values[:, -1].mean(), abs=1e-4)
    assert found.age_variance == pytest.approx(covariance[-1, -1], abs=1e-4)


def test_relaxed_arms_are_the_same_share_of_flexed_ones_in_training_and_report():
    shares = {
        definition.about.survey.fields[0]: definition.about.survey.share
        for definition in load_definitions()
        if definition.about.survey.share != 1.0 and definition.about.name != "hand_length"
    }
    assert shares == {source_name(name): share for name, share in RELAXED_SHARE.items()}


def test_a_sum_of_fields_has_the_moments_of_the_sum():
    moments = load_moments(packaged_moments_path(), "male")
    one, other = (moments.names.index(name) for name in ("stature", "crotchheight"))
    mean, covariance = moments.of([{"stature": 1.0, "crotchheight": -1.0}, {"stature": 2.0}])
    assert mean[0] == pytest.approx(moments.mean[one] - moments.mean[other])
    variances = moments.covariance[[one, other], [one, other]]
    difference = variances.sum() - 2.0 * moments.covariance[one, other]
    assert covariance[0, 0] == pytest.approx(difference)
    assert covariance[1, 1] == pytest.approx(4.0 * variances[0])
    with pytest.raises(KeyError, match="shoesize"):
        moments.of([{"shoesize": 1.0}])


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


@pytest.mark.slow
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
