import csv

import numpy as np
import pytest

from fitter.body.storage import load_body_model, packaged_model_path
from fitter.measurement.definitions import load_definitions
from fitter.training.report.survey_comparison import (
    NOTE_WIDTH,
    Moments,
    comparison_lines,
    drawn_measurements,
    effective_count,
    load_moments,
    matching_weights,
    note_lines,
    packaged_moments_path,
    survey_comparison,
    table_lines,
    weighted_moments,
)
from fitter.training.surveys.survey import (
    RELAXED_SHARE,
    load_statistics,
    packaged_statistics_path,
)
from tests.shared_data import SHARED_DATA, needs_shared


def test_numbers_line_up_under_their_heads():
    lines = table_lines("sizes", ("", "cm"), [("waist", "81.50"), ("a wider name", "9.00")])
    assert lines == (
        "  sizes",
        "                     cm",
        "    waist         81.50",
        "    a wider name   9.00",
    )


def test_a_table_without_heads_has_no_line_for_them():
    assert table_lines("sizes", ("", ""), [("waist", "81.5")]) == ("  sizes", "    waist  81.5")


def test_notes_are_wrapped_and_keep_their_words():
    text = "Every word of a long note is kept, whatever the width. " * 5
    lines = note_lines(text)
    assert len(lines) > 2
    assert max(map(len, lines)) <= NOTE_WIDTH + 4
    assert " ".join(line.strip() for line in lines) == text.strip()


GENDERS = ("female", "male")
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


@pytest.mark.parametrize("gender", GENDERS)
def test_the_packaged_moments_have_every_field_that_a_measurement_is_compared_with(gender: str):
    moments = load_moments(packaged_moments_path(), gender)
    assert np.linalg.eigvalsh(moments.covariance).min() > 0.0
    for definition in load_definitions():
        assert set(definition.about.survey.fields) <= set(moments.names)


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


@pytest.mark.parametrize("gender", GENDERS)
def test_moments_and_the_statistics_that_training_draws_from_are_of_one_survey(gender: str):
    moments = load_moments(packaged_moments_path(), gender)
    statistics = load_statistics(packaged_statistics_path(), gender)
    assert moments.count == statistics.count
    variance = np.diagonal(statistics.log_covariance)
    drawn = np.exp(statistics.log_mean + variance / 2)
    for name, mean in zip(statistics.names, drawn, strict=True):
        unit = 1.0 if name == "weightkg" else 100.0
        field = moments.mean[moments.names.index(source_name(name))]
        assert field == pytest.approx(unit * mean / RELAXED_SHARE.get(name, 1.0), rel=2e-3), name


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
