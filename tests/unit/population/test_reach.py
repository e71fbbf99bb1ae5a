"""The usual values by which units are judged are those of the models."""

import numpy as np
import pytest

from fitter.fits.prepared_model import prepared_model
from fitter.vocabulary.choices import Gender
from fitter.vocabulary.measurements import MEASUREMENT_UNITS
from fitter.vocabulary.reach import USUAL_REACH, other_unit

USUAL_SD = 3.0


def reach(gender: Gender, name: str) -> tuple[float, float]:
    shapes = prepared_model(gender).population.only(name).shapes
    (slope,) = shapes.jacobian_at_mean
    axis = USUAL_SD * slope / np.linalg.norm(slope)
    return float(shapes.measure(-axis, [0])[0]), float(shapes.measure(axis, [0])[0])


def test_every_measurement_has_a_reach():
    assert list(USUAL_REACH) == list(MEASUREMENT_UNITS)


@pytest.mark.parametrize("name", USUAL_REACH)
def test_the_reach_is_that_of_women_and_men_of_the_models(name):
    women, men = (reach(gender, name) for gender in (Gender.FEMALE, Gender.MALE))
    low, high = USUAL_REACH[name]
    assert low <= min(women[0], men[0]) < low + 1.01
    assert high - 1.01 < max(women[1], men[1]) <= high


@pytest.mark.parametrize(
    ("name", "values", "unit"),
    [
        ("chest_girth", [32.0, 42.0], "inches"),
        ("waist_girth_navel", [0.8], "metres"),
        ("hip_girth", [940.0, 980.0], "millimetres"),
        ("weight", [300.0, 310.0], "pounds"),
    ],
)
def test_values_that_nobody_has_are_those_of_another_unit(name, values, unit):
    found = other_unit(name, values)
    assert found is not None
    assert found[1] == unit


def test_one_usual_value_or_no_unit_at_all_is_no_other_unit():
    assert other_unit("chest_girth", [32.0, 80.0]) is None
    assert other_unit("chest_girth", [7.0]) is None
