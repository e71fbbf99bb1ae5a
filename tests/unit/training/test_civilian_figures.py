import numpy as np
import pytest

from fitter.training.report.civilian_figures import figures_of_civilians, figures_of_people
from fitter.training.surveys.civilians import load_civilians, packaged_civilians_path


def test_people_are_told_by_their_index_and_the_geometric_mean_of_their_waists():
    figures = figures_of_people(np.array([[150.0, 45.0, 60.0], [200.0, 100.0, 90.0]]))
    np.testing.assert_allclose(figures.mean, [175.0, 72.5, 22.5])
    np.testing.assert_allclose(figures.deviation, [25.0, 27.5, 2.5])
    assert figures.correlation == pytest.approx(1.0)
    assert figures.waist_cm == pytest.approx(np.sqrt(60.0 * 90.0))


@pytest.mark.parametrize(("gender", "stature"), [("female", 159.8), ("male", 173.2)])
def test_civilians_with_even_ages_have_the_surveys_means(gender: str, stature: float):
    statistics = load_civilians(packaged_civilians_path(), gender)
    figures = figures_of_civilians(statistics, np.random.default_rng(0), 3000)
    ages = np.linspace(18.0, 80.0, 2001)
    surveyed = [
        100.0 * np.exp(np.interp(ages, statistics.age, column).mean())
        for column in (statistics.log_stature, statistics.log_waist)
    ]
    # Means are of the people, not of logarithms: a spread of 4 % lifts them by 0.1 cm.
    assert figures.mean[0] == pytest.approx(surveyed[0] + 0.15, abs=0.4)
    assert figures.mean[0] == pytest.approx(stature, abs=0.6)
    assert figures.waist_cm == pytest.approx(surveyed[1], abs=0.4)
    assert 25.0 < figures.mean[2] < 31.0
