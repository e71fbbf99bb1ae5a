import numpy as np
import pytest

from fitter.training.surveys.survey import (
    AGES,
    BMI_RANGE,
    draw_civilian,
    load_civilians,
    packaged_civilians_path,
)

GENDERS = ("female", "male")


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
