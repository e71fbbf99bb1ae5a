"""Bodies from measurements alone, on the shipped models."""

import numpy as np
import pytest

from fitter.body.shape_space import height_of_shape, shape_for_height
from fitter.energies.shape_terms import height_extrapolation
from fitter.errors import InvalidInputError
from fitter.fits.equipment import PreparedModel, prepared_model
from fitter.measurement.anthropometry import measurement_values
from fitter.measurement.definitions import INTERVAL_SD
from fitter.population.body_estimate import BodyEstimate, estimate_body
from fitter.population.conditional_shape import MeasuredPopulation
from fitter.population.known import conditioned_population
from fitter.request import KnownMeasurement
from fitter.vocabulary.choices import Gender
from fitter.vocabulary.measurements import STATURE

GENDERS = pytest.mark.parametrize("gender", list(Gender))


def body(gender: Gender) -> PreparedModel:
    return prepared_model(gender)


def population(gender: Gender) -> MeasuredPopulation:
    return body(gender).population


def estimate(gender: Gender, **known: float | tuple[float, float]) -> BodyEstimate:
    return estimate_body(
        population(gender),
        {
            name: KnownMeasurement(value=value[0], standard_error=value[1])
            if isinstance(value, tuple)
            else KnownMeasurement(value=value)
            for name, value in known.items()
        },
    )


def values(estimated: BodyEstimate) -> dict[str, float]:
    return {each.name: each.value for each in estimated.measurements}


def typical(gender: Gender, *deviations: float) -> dict[str, float]:
    """Measurements of somebody of the population."""
    shape = np.zeros(len(body(gender).measuring.canonical.derivative))
    shape[: len(deviations)] = deviations
    names = population(gender).names
    measured = measurement_values(body(gender).measuring, shape)
    return dict(zip(names, measured.tolist(), strict=True))


@GENDERS
def test_the_height_alone_gives_the_mean_person_of_section_3_1(gender):
    estimated = estimate(gender, stature=174.0)
    evaluator = body(gender).operators.evaluator
    assert np.abs(estimated.shape - shape_for_height(evaluator, 1.74)).max() < 5e-3
    assert height_of_shape(evaluator, estimated.shape) == pytest.approx(1.74, abs=1e-4)


@GENDERS
def test_nothing_known_gives_the_mean_body_with_the_populations_spread(gender):
    estimated = estimate(gender)
    assert np.array_equal(estimated.shape, np.zeros_like(estimated.shape))
    assert estimated.plausibility == 1.0
    stature = estimated.measurements[0]
    assert stature.standard_error > 3.8


@GENDERS
def test_known_measurements_are_held_and_have_no_interval(gender):
    person = typical(gender, 0.8, 0.9, -0.7, 0.5)
    known = {name: person[name] for name in ("stature", "weight", "waist_girth_navel", "inseam")}
    estimated = estimate(gender, **known)
    for each in estimated.measurements:
        name = each.name
        if name in known:
            assert each.value == pytest.approx(known[name], abs=0.011)
        assert (each.standard_error == 0.0) == (name in known)


@GENDERS
def test_all_measurements_of_somebody_give_that_somebodys_measurements(gender):
    person = typical(gender, -0.4, 1.1, 0.3, -0.6, 0.2, 0.4)
    assert values(estimate(gender, **person)) == pytest.approx(person, abs=0.02)


@GENDERS
@pytest.mark.parametrize("seed", [1, 2])
def test_all_measurements_of_anybody_are_met_however_weakly_they_tell_shapes_apart(gender, seed):
    person = typical(gender, *np.random.default_rng(seed).standard_normal(20))
    assert values(estimate(gender, **person)) == pytest.approx(person, abs=0.02)


@GENDERS
def test_every_further_measurement_narrows_the_others(gender):
    person = typical(gender, 0.5, 0.5, 0.5)
    spreads: list[float] = []
    known: dict[str, float] = {}
    for name in ("stature", "weight", "waist_girth_navel", "hip_girth"):
        estimated = estimate(gender, **known)
        chest = next(e for e in estimated.measurements if e.name == "chest_girth")
        spreads.append(chest.standard_error)
        known[name] = person[name]
    assert spreads == sorted(spreads, reverse=True)
    assert spreads[-1] < 0.6 * spreads[0]


@pytest.mark.slow
@GENDERS
def test_nineteen_in_twenty_people_lie_within_their_intervals(gender):
    rng = np.random.default_rng(11)
    measuring, names = body(gender).measuring, population(gender).names
    inside: list[bool] = []
    for _ in range(40):
        shape = rng.standard_normal(len(measuring.canonical.derivative))
        person = dict(zip(names, measurement_values(measuring, shape).tolist(), strict=True))
        estimated = estimate(gender, stature=person["stature"], weight=person["weight"])
        inside += [
            abs(person[each.name] - each.value) <= INTERVAL_SD * each.standard_error
            for each in estimated.measurements
            if each.standard_error
        ]
    assert np.mean(inside) == pytest.approx(0.95, abs=0.03)


def test_heavier_is_wider_and_no_taller_when_the_height_is_held():
    light, heavy = (values(estimate(Gender.FEMALE, stature=168.0, weight=w)) for w in (55.0, 85.0))
    assert heavy["stature"] == pytest.approx(light["stature"], abs=0.02)
    for girth in ("chest_girth", "waist_girth_navel", "hip_girth", "thigh_girth"):
        assert heavy[girth] > light[girth] + 5.0


def refusal(gender: Gender, **known: float | tuple[float, float]) -> InvalidInputError:
    with pytest.raises(InvalidInputError) as caught:
        estimate(gender, **known)
    return caught.value


def test_a_name_that_is_not_measured_is_refused_with_those_that_are():
    problem = refusal(Gender.MALE, waist=90.0)
    assert (problem.code, problem.field) == ("unknown-value", "measurements.waist")
    assert "waist_girth_navel" in problem.remedy


@pytest.mark.parametrize(
    ("known", "unit", "right"),
    [
        ({"stature": 1.75}, "metres", "175"),
        ({"stature": 69.0}, "inches", "175.3"),
        ({"weight": 330.0}, "pounds", "149.7"),
        ({"waist_girth_navel": 920.0}, "millimetres", "92"),
    ],
)
def test_a_value_in_another_unit_is_recognised(known, unit, right):
    problem = refusal(Gender.MALE, **known)
    assert problem.code == "out-of-range"
    assert unit in problem.reason
    assert f"Send {right}:" in problem.remedy


@pytest.mark.parametrize("stature", [119.9, 230.1, 260.0])
def test_a_height_that_no_request_may_name_is_refused_with_the_range(stature):
    problem = refusal(Gender.FEMALE, stature=stature)
    assert (problem.code, problem.field) == ("out-of-range", "measurements.stature")
    assert "120 to 230 cm" in problem.reason


@GENDERS
@pytest.mark.parametrize("stature", [120.0, 230.0])
def test_beyond_usual_heights_errors_are_wider_and_a_warning_says_so(gender, stature):
    people = population(gender)
    known = {STATURE: KnownMeasurement(value=stature)}
    unusual, usual = estimate(gender, stature=stature), estimate(gender, stature=170.0)
    assert values(unusual)["stature"] == pytest.approx(stature, abs=0.01)
    (warning,) = unusual.warnings
    conditioned = conditioned_population(people, known)
    wider = np.sqrt(height_extrapolation(conditioned.shape[0]))
    assert wider > 1.25
    assert (warning.code, f"{wider:.2f} times" in warning.reason) == ("unusual-height", True)
    variances = np.diag(conditioned.jacobian @ conditioned.covariance @ conditioned.jacobian.T)
    for each, variance in zip(unusual.measurements, variances, strict=True):
        if each.standard_error:
            assert each.standard_error == pytest.approx(wider * np.sqrt(variance))
    assert usual.warnings == ()


def test_who_is_unusually_tall_may_have_the_limbs_and_the_weight_of_such_people():
    tall = values(estimate(Gender.FEMALE, stature=215.0))
    known = {name: tall[name] for name in ("stature", "inseam", "arm_length", "weight")}
    assert values(estimate(Gender.FEMALE, **known))["inseam"] == pytest.approx(
        tall["inseam"], abs=0.01
    )
    assert refusal(Gender.FEMALE, inseam=tall["inseam"]).code == "out-of-range"
    problem = refusal(Gender.FEMALE, **known | {"inseam": 60.0})
    assert problem.code == "contradictory-measurements"


def test_measurements_nobody_has_together_name_the_one_that_does_not_fit():
    person = typical(Gender.MALE) | {"calf_girth": 50.0}
    known = {n: person[n] for n in ("stature", "weight", "waist_girth_navel", "calf_girth")}
    problem = refusal(Gender.MALE, **known)
    assert (problem.code, problem.field) == (
        "contradictory-measurements",
        "measurements.calf_girth",
    )
    assert "expected between" in problem.reason


def test_what_contradicts_when_exact_may_agree_within_its_errors():
    known = {"waist_girth_navel": 80.0, "waist_girth_smallest": 90.0}
    assert refusal(Gender.MALE, **known).code == "contradictory-measurements"
    loose = estimate(Gender.MALE, **{name: (value, 6.0) for name, value in known.items()})
    assert loose.plausibility < 0.5
