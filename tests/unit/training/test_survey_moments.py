import csv

import numpy as np
import pytest

from fitter.measurement.definition_file import load_definitions
from fitter.training.surveys.survey import (
    RELAXED_SHARE,
    load_statistics,
    packaged_statistics_path,
)
from fitter.training.surveys.survey_moments import load_moments, packaged_moments_path
from tests.shared_data import SHARED_DATA, needs_shared

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
