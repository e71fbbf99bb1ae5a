import numpy as np
import pytest

from fitter.applications.composition import body_fat, body_mass_index
from fitter.measurement.joint_measurements import JointMeasurements
from fitter.vocabulary.choices import Gender

BODY = {
    "stature": 178.0,
    "weight": 78.0,
    "waist_girth_navel": 85.0,
    "waist_girth_smallest": 74.0,
    "hip_girth": 99.0,
    "neck_girth": 38.0,
}
ERRORS = {"waist_girth_navel": 2.0, "waist_girth_smallest": 2.0, "neck_girth": 1.0, "weight": 3.0}


def person(errors=ERRORS, correlation=0.0, **changes):
    body = BODY | changes
    spread = np.array([errors.get(name, 0.0) for name in body])
    correlations = np.full((len(body), len(body)), correlation)
    np.fill_diagonal(correlations, 1.0)
    return JointMeasurements(
        names=tuple(body),
        units=tuple("kg" if name == "weight" else "cm" for name in body),
        values=np.array(list(body.values())),
        covariance=correlations * np.outer(spread, spread),
    )


def of(name, someone, gender=Gender.MALE, age=None):
    return next(each for each in body_fat(someone, gender, age) if each.regression.name == name)


def test_the_navy_s_equations_give_what_their_inch_forms_give():
    """The US Department of Defense publishes them in inches, as a share of fat at once."""
    man = of("us_navy", person())
    inches = 86.010 * np.log10((85.0 - 38.0) / 2.54) - 70.041 * np.log10(178.0 / 2.54) + 36.76
    assert man.percent == pytest.approx(inches, abs=0.5)
    woman = of("us_navy", person(neck_girth=33.0, stature=166.0, weight=63.0), Gender.FEMALE)
    inches = (
        163.205 * np.log10((74.0 + 99.0 - 33.0) / 2.54) - 97.684 * np.log10(166.0 / 2.54) - 78.387
    )
    assert woman.percent == pytest.approx(inches, abs=0.7)


def test_cun_bae_of_a_man_of_forty_is_what_its_terms_sum_to():
    found = of("cun_bae", person(), age=40.0)
    bmi = 78.0 / 1.78**2
    expected = -44.988 + 0.503 * 40 + 3.172 * bmi - 0.026 * bmi**2 - 0.02 * bmi * 40
    assert found.percent == pytest.approx(expected + 0.00021 * bmi**2 * 40)
    assert body_mass_index(person()) == pytest.approx(bmi)


def test_the_error_is_the_regression_s_and_the_measurements_in_squares():
    exact = of("us_navy", person(errors={}))
    assert exact.standard_error == 3.52
    found = of("us_navy", person())
    # d fat = 495 / density² x 0.19077 / ln 10 x d (waist - neck) / (waist - neck).
    density = 495.0 / (found.percent + 450.0)
    slope = 495.0 / density**2 * 0.19077 / np.log(10.0) / (85.0 - 38.0)
    assert found.standard_error == pytest.approx(
        np.hypot(3.52, slope * np.hypot(2.0, 1.0)), rel=1e-5
    )


def test_waists_and_necks_that_err_alike_make_less_of_an_error_in_a_difference():
    apart = of("us_navy", person())
    together = of("us_navy", person(correlation=0.9))
    assert together.standard_error < apart.standard_error


@pytest.mark.parametrize(
    ("name", "age", "changes", "said"),
    [
        ("us_navy", 16.0, {}, "18 to 60 years, not of 16"),
        ("us_navy", 70.0, {}, "18 to 60 years, not of 70"),
        ("us_navy", None, {"weight": 140.0}, "not to 44.2"),
        ("us_navy", None, {"weight": 50.0}, "18.5 to 35"),
        ("us_navy", None, {"neck_girth": 90.0}, "between 0 and 100 %"),
        ("cun_bae", None, {}, "needs an age"),
        ("cun_bae", 85.0, {}, "not of 85"),
    ],
)
def test_outside_its_population_a_regression_says_why_it_says_nothing(name, age, changes, said):
    found = of(name, person(**changes), age=age)
    assert found.percent is found.standard_error is None
    assert said in " ".join(found.withheld)
