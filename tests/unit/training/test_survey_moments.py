from pathlib import Path

import numpy as np
import pytest

from fitter.measurement.definition_file import load_definitions
from fitter.training.surveys.survey import load_statistics, packaged_statistics_path
from fitter.training.surveys.survey_files import RELAXED_SHARE, SOURCE_NAMES
from fitter.training.surveys.survey_moments import (
    FIELDS,
    load_moments,
    moments_from_survey,
    packaged_moments_path,
    save_moments,
)

GENDERS = ("female", "male")


@pytest.mark.parametrize("gender", GENDERS)
def test_the_packaged_moments_have_every_field_that_a_measurement_is_compared_with(gender: str):
    moments = load_moments(packaged_moments_path(), gender)
    assert moments.names == FIELDS
    assert np.linalg.eigvalsh(moments.covariance).min() > 0.0
    for definition in load_definitions():
        assert set(definition.about.survey.fields) <= set(FIELDS)


@pytest.mark.parametrize("gender", GENDERS)
def test_moments_and_the_statistics_that_training_draws_from_are_of_one_survey(gender: str):
    moments = load_moments(packaged_moments_path(), gender)
    statistics = load_statistics(packaged_statistics_path(), gender)
    assert moments.count == statistics.count
    variance = np.diagonal(statistics.log_covariance)
    means = dict(zip(statistics.names, np.exp(statistics.log_mean + variance / 2), strict=True))
    for name, mean in zip(moments.names, moments.mean, strict=True):
        ours = next((key for key, field in SOURCE_NAMES.items() if field == name), name)
        if ours in means:
            unit = 1.0 if name == "weightkg" else 100.0
            drawn = unit * means[ours] / RELAXED_SHARE.get(ours, 1.0)
            assert mean == pytest.approx(drawn, rel=2e-3), name


def test_relaxed_arms_are_the_same_share_of_flexed_ones_in_training_and_report():
    shares = {
        definition.about.survey.fields[0]: definition.about.survey.share
        for definition in load_definitions()
        if definition.about.survey.share != 1.0 and definition.about.name != "hand_length"
    }
    assert shares == {SOURCE_NAMES[name]: share for name, share in RELAXED_SHARE.items()}


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


def test_moments_of_a_survey_file_survive_saving(tmp_path: Path):
    values = np.random.default_rng(2).normal(1700.0, 60.0, (300, 2))
    lines = ["stature,weightkg", *(",".join(f"{value:.6f}" for value in row) for row in values)]
    (tmp_path / "survey.csv").write_text("\n".join(lines), encoding="latin-1")
    found = moments_from_survey(tmp_path / "survey.csv", ("stature", "weightkg"))
    save_moments(tmp_path / "moments.json", {"male": found})
    loaded = load_moments(tmp_path / "moments.json", "male")
    assert (loaded.names, loaded.count) == (("stature", "weightkg"), 300)
    np.testing.assert_allclose(loaded.mean, values.mean(axis=0) / 10.0, atol=1e-4)
    np.testing.assert_allclose(loaded.covariance, np.cov(values.T) / 100.0, atol=1e-4)
