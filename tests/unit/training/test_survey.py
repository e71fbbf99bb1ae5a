import numpy as np
import pytest

from fitter.training.surveys.survey import (
    Civilian,
    draw_measurements,
    load_civilians,
    load_statistics,
    on_the_model,
    packaged_civilians_path,
    packaged_statistics_path,
    regression,
)
from fitter.training.surveys.survey_measurements import MEASUREMENTS

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
