from pathlib import Path

import numpy as np
import pytest

from fitter.training.survey import (
    CIVILIAN_BMI,
    draw_subjects,
    load_statistics,
    on_the_model,
    packaged_statistics_path,
)
from fitter.training.survey_files import save_statistics, statistics_from_survey
from fitter.training.survey_measurements import MEASUREMENTS

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
def test_drawn_subjects_have_civilian_weight_and_the_surveys_stature(gender: str):
    statistics = load_statistics(packaged_statistics_path(), gender)
    drawn = draw_subjects(statistics, gender, 20_000, np.random.default_rng(0))
    stature, weight = (drawn[:, MEASUREMENTS.index(name)] for name in ("stature", "weightkg"))
    index = weight / stature**2
    np.testing.assert_allclose(np.percentile(index, [2.5, 97.5]), CIVILIAN_BMI[gender], rtol=0.02)
    assert abs(np.corrcoef(np.log(index), np.log(stature))[0, 1]) < 0.03
    log_stature = MEASUREMENTS.index("stature")
    assert np.log(stature).mean() == pytest.approx(statistics.log_mean[log_stature], abs=1e-3)
    deviation = np.sqrt(statistics.log_covariance[log_stature, log_stature])
    assert np.log(stature).std() == pytest.approx(deviation, rel=0.02)


def test_at_given_stature_and_weight_the_rest_varies_as_in_the_survey():
    statistics = load_statistics(packaged_statistics_path(), "female")
    drawn = np.log(draw_subjects(statistics, "female", 50_000, np.random.default_rng(1)))
    given = [MEASUREMENTS.index(name) for name in ("stature", "weightkg")]
    others = [k for k in range(len(MEASUREMENTS)) if k not in given]

    def residual(covariance: np.ndarray) -> np.ndarray:
        slope = np.linalg.solve(covariance[np.ix_(given, given)], covariance[np.ix_(given, others)])
        return covariance[np.ix_(others, others)] - covariance[np.ix_(others, given)] @ slope

    expected = residual(statistics.log_covariance)
    found = residual(np.cov(drawn.T))
    scale = np.sqrt(np.outer(np.diagonal(expected), np.diagonal(expected)))
    assert np.abs((found - expected) / scale).max() < 0.03


def test_definitions_that_agree_are_left_as_surveyed():
    surveyed = np.ones(len(MEASUREMENTS))
    on_model = on_the_model(MEASUREMENTS, "female", surveyed)
    assert on_model[MEASUREMENTS.index("waistcircumference")] == 1.0
    assert on_model[MEASUREMENTS.index("hipbreadth")] == pytest.approx(1.058)
    assert on_model[MEASUREMENTS.index("acromialheight")] == pytest.approx(1.010)


def test_statistics_of_a_survey_file_survive_saving(tmp_path: Path):
    generator = np.random.default_rng(2)
    logarithms = generator.multivariate_normal([7.4, 6.5, 5.6], 0.01 * (np.eye(3) + 0.5), 400)
    rows = ["stature,weightkg,bicepscircumferenceflexed"]
    rows += [",".join(f"{value:.6f}" for value in row) for row in np.exp(logarithms)]
    path = tmp_path / "survey.csv"
    path.write_text("\n".join(rows), encoding="latin-1")
    statistics = statistics_from_survey(path, ("stature", "weightkg", "bicepscircumference"))
    save_statistics(tmp_path / "statistics.json", {"male": statistics})
    loaded = load_statistics(tmp_path / "statistics.json", "male")
    assert loaded.count == 400
    units = np.log([1000.0, 10.0, 1000.0 / 0.93])
    np.testing.assert_allclose(loaded.log_mean, logarithms.mean(axis=0) - units, atol=1e-5)
    np.testing.assert_allclose(loaded.log_covariance, np.cov(logarithms.T), atol=1e-6)
