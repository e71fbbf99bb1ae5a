"""Whom a fit begins from, on the shipped models."""

import numpy as np
import pytest

from fitter.body.shape_space import height_of_shape, shape_for_height
from fitter.errors import InvalidInputError
from fitter.fits.equipment import prepared_model
from fitter.measurement.anthropometry import measure
from fitter.observation.subject import MEAN_HEIGHT_M, check_person
from fitter.population.body_estimate import estimate_body
from fitter.population.known_person import KnownPerson, known_person
from fitter.request import KnownMeasurement, Person
from fitter.vocabulary.choices import Gender

GENDERS = pytest.mark.parametrize("gender", list(Gender))


def told(gender: Gender, height_m: float | None, **known: float | tuple[float, float]):
    return Person(
        gender=gender,
        height_m=height_m,
        measurements={
            name: KnownMeasurement(value=value[0], standard_error=value[1])
            if isinstance(value, tuple)
            else KnownMeasurement(value=value)
            for name, value in known.items()
        },
    )


def person(gender: Gender, height_m: float | None, **known) -> KnownPerson:
    body = prepared_model(gender)
    asked = told(gender, height_m, **known)
    return known_person(asked, body.population, body.operators.evaluator)


def measured(gender: Gender, known: KnownPerson) -> dict[str, float]:
    body = prepared_model(gender).measuring
    return {each.name: each.value for each in measure(body, known.shape)}


def typical(gender: Gender, *deviations: float) -> dict[str, float]:
    body = prepared_model(gender).measuring
    shape = np.zeros(len(body.canonical.derivative))
    shape[: len(deviations)] = deviations
    return {each.name: each.value for each in measure(body, shape)}


@GENDERS
def test_a_height_alone_is_the_mean_person_of_section_3_1(gender):
    found = person(gender, 1.71)
    evaluator = prepared_model(gender).operators.evaluator
    np.testing.assert_array_equal(found.shape, shape_for_height(evaluator, 1.71))
    assert (found.height_m, found.height_variance) == (1.71, 0.0)
    assert (found.given, found.held, found.assumptions) == (("stature",), ("stature",), ())


@GENDERS
def test_nothing_known_is_the_mean_height_and_says_so(gender):
    found = person(gender, None)
    assert found.height_m == MEAN_HEIGHT_M[gender]
    assert (found.height_variance, found.given, found.held) == (1.0, (), ())
    assert [each.code for each in found.assumptions] == ["height-assumed"]


@pytest.mark.parametrize("known", [{}, {"weight": 80.0}])
def test_a_height_that_few_have_is_taken_with_a_warning(known):
    for height_m in (1.3, 2.1):
        (warning,) = person(Gender.FEMALE, height_m, **known).warnings
        assert warning.code == "unusual-height"
        assert f"At {100 * height_m:.0f} cm" in warning.reason
    assert person(Gender.FEMALE, 1.7, **known).warnings == ()


@GENDERS
def test_what_is_given_is_had_from_the_beginning(gender):
    truth = typical(gender, 0.7, 1.2, -0.8, 0.4)
    names = ("weight", "waist_girth_navel", "inseam")
    found = person(gender, truth["stature"] / 100, **{name: truth[name] for name in names})
    values = measured(gender, found)
    for name in ("stature", *names):
        assert values[name] == pytest.approx(truth[name], abs=2e-3)
    assert found.given == found.held == ("stature", *names)
    assert found.attributes.held.values.tolist() == [truth[name] for name in names]
    assert not len(found.attributes.standard_errors)


@GENDERS
def test_without_a_height_the_most_probable_one_is_taken_and_said(gender):
    tall = typical(gender, 1.5)
    found = person(gender, None, inseam=tall["inseam"])
    mean = typical(gender)["stature"] / 100
    assert mean + 0.05 < found.height_m < mean + 0.15
    (assumption,) = found.assumptions
    assert assumption.where == ("height_m",)
    assert f"{found.height_m:.2f} m" in assumption.reason
    assert "inseam" in assumption.reason
    assert 0.02 < found.height_variance < 0.6
    evaluator = prepared_model(gender).operators.evaluator
    assert height_of_shape(evaluator, found.shape) == pytest.approx(found.height_m, abs=1e-5)
    assert measured(gender, found)["inseam"] == pytest.approx(tall["inseam"], abs=2e-3)


@GENDERS
def test_a_measured_stature_is_a_height(gender):
    truth = typical(gender, 0.5, 0.5)
    exact = person(gender, None, stature=truth["stature"], weight=truth["weight"])
    same = person(gender, truth["stature"] / 100, weight=truth["weight"])
    assert exact.height_m == pytest.approx(same.height_m)
    np.testing.assert_allclose(exact.shape, same.shape, atol=1e-5)
    assert exact.height_variance == pytest.approx(0.0, abs=1e-9)
    assert exact.assumptions == ()


@GENDERS
def test_an_uncertain_stature_is_drawn_toward_and_stays_uncertain(gender):
    mean = typical(gender)["stature"]
    found = person(gender, None, stature=(mean + 10.0, 5.0))
    assert mean + 3.0 < 100 * found.height_m < mean + 10.0
    assert 0.1 < found.height_variance < 0.9
    assert (found.assumptions, found.given, found.held) == ((), ("stature",), ())


@GENDERS
def test_it_is_the_body_that_measurements_alone_give(gender):
    truth = typical(gender, 0.3, -0.6, 0.9)
    known = {"weight": (truth["weight"], 2.0), "hip_girth": truth["hip_girth"]}
    asked = told(gender, None, stature=truth["stature"], **known)
    alone = estimate_body(prepared_model(gender).population, asked.measurements)
    found = person(gender, truth["stature"] / 100, **known)
    np.testing.assert_allclose(found.shape, alone.shape, atol=5e-3)


@pytest.mark.parametrize(
    ("height_m", "known", "field", "code"),
    [
        (1.7, {"bust": 90.0}, "measurements.bust", "unknown-value"),
        (1.7, {"weight": 600.0}, "measurements.weight", "out-of-range"),
        (1.7, {"weight": 45.0, "waist_girth_navel": 110.0}, None, "contradictory-measurements"),
        (1.85, {"inseam": 70.0}, None, "contradictory-measurements"),
        (None, {"stature": 231.0}, "measurements.stature", "out-of-range"),
    ],
)
def test_what_nobody_is_is_refused_by_its_field(height_m, known, field, code):
    with pytest.raises(InvalidInputError) as caught:
        person(Gender.FEMALE, height_m, **known)
    fields = {"height_m", *(f"measurements.{name}" for name in known)}
    assert caught.value.code == code
    assert caught.value.field in (fields if field is None else {field})
    if code == "contradictory-measurements":
        assert all(name in caught.value.reason for name in known)
        assert "standard_error" in caught.value.remedy


def test_a_field_of_its_own_is_named():
    body = prepared_model(Gender.MALE)
    asked = Person(
        gender=Gender.MALE,
        height_m=1.8,
        measurements={"weight": KnownMeasurement(value=900.0, field="weight_kg")},
    )
    with pytest.raises(InvalidInputError) as caught:
        known_person(asked, body.population, body.operators.evaluator)
    assert caught.value.field == "weight_kg"


@pytest.mark.parametrize("value", [0.0, -70.0, float("nan"), float("inf")])
def test_a_value_that_is_none_is_refused(value):
    with pytest.raises(InvalidInputError) as caught:
        check_person(told(Gender.MALE, 1.8, weight=value))
    assert (caught.value.code, caught.value.field) == ("measurement-invalid", "measurements.weight")


def test_a_height_said_twice_is_refused():
    with pytest.raises(InvalidInputError) as caught:
        check_person(told(Gender.MALE, 1.8, stature=180.0))
    assert (caught.value.code, caught.value.field) == ("two-heights", "height_m")
