import numpy as np
import pytest

from fitter.measurement.definition_file import load_definitions
from fitter.training.surveys.age_effect import age_effect
from fitter.training.surveys.civilians import Civilian
from fitter.training.surveys.survey import load_statistics, packaged_statistics_path, regression

DEFINITIONS = load_definitions()
NAMES = [definition.about.name for definition in DEFINITIONS]


@pytest.mark.parametrize("gender", ["female", "male"])
def test_age_moves_a_waist_as_the_surveys_regression_does(gender: str):
    statistics = load_statistics(packaged_statistics_path(), gender)
    found = regression(statistics)
    stature, weight = (
        float(statistics.median[statistics.names.index(name)]) for name in ("stature", "weightkg")
    )
    waist = statistics.names.index("waistcircumference")
    young, old = (
        np.exp(found.expected(Civilian(age=age, stature=stature, weight=weight)))[waist]
        for age in (statistics.age_mean, 49.0)
    )
    effect = age_effect(gender, DEFINITIONS)[NAMES.index("waist_girth_navel")]
    assert effect == pytest.approx((old - young) / statistics.deviation[waist], abs=0.01)
    assert effect > 0.15


def test_what_people_are_matched_by_does_not_go_with_age():
    effects = age_effect("female", DEFINITIONS)
    assert abs(effects[NAMES.index("stature")]) < 1e-6
    assert abs(effects[NAMES.index("weight")]) < 1e-6


def test_flexed_arms_are_known_and_backs_are_not():
    effects = dict(zip(NAMES, age_effect("male", DEFINITIONS), strict=True))
    assert np.isfinite(effects["forearm_girth"])
    assert np.isnan(effects["back_waist_length"])
