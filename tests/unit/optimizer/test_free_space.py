"""Searches keep to the bodies that have what is known."""

from dataclasses import replace

import numpy as np
import pytest

from fitter.energies.objective import JointCandidate, JointObjective
from fitter.energies.shape_terms import (
    NOTHING_KNOWN,
    attribute_energy,
    attribute_residuals,
    attribute_slopes,
    height_extrapolation,
)
from fitter.errors import NumericalError
from fitter.fits.equipment import PreparedModel, prepared_model
from fitter.measurement.anthropometry import measure
from fitter.optimizer.free_space import HELD_WITHIN, free_space, held_shape
from fitter.optimizer.joint_equations import joint_equations
from fitter.optimizer.search import minimize_gauss_newton, minimize_simplex
from fitter.optimizer.uncertainty import certainty, shape_covariance
from fitter.parameters import BodyParameters
from fitter.population.known_person import KnownPerson, known_person
from fitter.request import KnownMeasurement, Person
from fitter.vocabulary.choices import Gender
from tests.unit.optimizer.rendered_scene import RenderedScene, of_person, rendered_scene

HELD = ("weight", "waist_girth_navel", "inseam")


def body() -> PreparedModel:
    return prepared_model(Gender.MALE)


@pytest.fixture(scope="module")
def scene() -> RenderedScene:
    return rendered_scene(0)


def ignore(_):
    return None


def measured(shape: np.ndarray) -> dict[str, float]:
    return {each.name: each.value for each in measure(body().measuring, shape)}


def spreads(
    objective: JointObjective, candidate: JointCandidate, height_variance: float
) -> dict[str, float]:
    """Standard errors of the body's own measurements: how certain the fit is."""
    shape = candidate.shape
    measuring = replace(body().measuring, unexplained=np.zeros_like(body().measuring.unexplained))
    (certain,) = certainty(objective, candidate)
    covariance = shape_covariance(certain, height_variance=height_variance)
    return {
        each.name: each.standard_error or 0.0
        for each in measure(measuring, shape, shape_covariance=covariance)
    }


def person(scene: RenderedScene, standard_errors: dict[str, float]) -> KnownPerson:
    """What a caller says who knows the truth of the stature and of these."""
    truth = measured(scene.truth.shape)
    told = Person(
        gender=Gender.MALE,
        height_m=truth["stature"] / 100.0,
        measurements={
            name: KnownMeasurement(value=truth[name], standard_error=error)
            for name, error in standard_errors.items()
        },
    )
    return known_person(told, body().population, body().operators.evaluator)


def begun(scene: RenderedScene, known: KnownPerson) -> tuple[JointObjective, list[BodyParameters]]:
    objective = of_person(scene.objective, attributes=known.attributes)
    return objective, [replace(scene.start, shape=known.shape)]


def test_with_nothing_known_all_but_the_height_is_free(scene):
    space = free_space(NOTHING_KNOWN.held, scene.start.shape)
    n, free = space.directions.shape
    assert free == n - 1
    assert not space.directions[0].any()
    np.testing.assert_array_equal(space.directions[1:], np.eye(free))
    assert space.height_response.tolist() == [1.0] + [0.0] * (len(scene.start.shape) - 1)


def test_along_the_free_directions_held_attributes_stand_still(scene):
    known = person(scene, dict.fromkeys(HELD, 0.0))
    space = free_space(known.attributes.held, known.shape)
    n, free = space.directions.shape
    assert free == n - 1 - len(HELD)
    np.testing.assert_allclose(space.directions.T @ space.directions, np.eye(free), atol=1e-12)
    before, step = measured(known.shape), 1e-3
    for direction in space.directions.T[-4:]:
        after = measured(known.shape + step * direction)
        for name in ("stature", *HELD):
            assert after[name] == pytest.approx(before[name], abs=2e-5)
        # Something else does change, or the test would say nothing.
        assert max(abs(after[name] - before[name]) for name in after) > 2e-4


def test_the_height_may_change_and_what_else_is_held_stays(scene):
    known = person(scene, dict.fromkeys(HELD, 0.0))
    space = free_space(known.attributes.held, known.shape)
    assert space.height_response[0] == 1.0
    before = measured(known.shape)
    after = measured(known.shape + 0.01 * space.height_response)
    assert after["stature"] > before["stature"] + 0.05
    for name in HELD:
        assert after[name] == pytest.approx(before[name], abs=2e-3)


@pytest.mark.parametrize("size", [0.3, 1.5])
def test_a_step_ends_on_a_body_that_has_what_is_held(scene, size):
    known = person(scene, dict.fromkeys(HELD, 0.0))
    parameters = replace(scene.start, shape=known.shape)
    space = free_space(known.attributes.held, known.shape)
    rng = np.random.default_rng(4)
    own = 0.1 * rng.standard_normal(parameters.pose.size + 3)
    change = size * rng.standard_normal(len(known.shape))
    change = space.directions @ (space.directions.T @ change)
    both = space.moved([parameters, scene.start], [own, 0.0 * own], change)
    assert both is not None
    reached, other = both
    np.testing.assert_array_equal(reached.shape, other.shape)
    np.testing.assert_array_equal(other.translation, scene.start.translation)
    np.testing.assert_allclose(reached.translation - parameters.translation, own[-3:])
    assert np.linalg.norm(reached.shape - parameters.shape) > size
    assert reached.shape[0] == parameters.shape[0]
    found, wanted = measured(reached.shape), measured(scene.truth.shape)
    for name in HELD:
        assert found[name] == pytest.approx(wanted[name], abs=HELD_WITHIN)


def test_two_attributes_that_say_the_same_hold_the_body_once(scene):
    once = person(scene, {"weight": 0.0}).attributes.held
    twice = replace(
        once,
        measure=lambda shape: np.tile(once.measure(shape), 2),
        jacobian=lambda shape: np.tile(once.jacobian(shape), (2, 1)),
        values=np.tile(once.values, 2),
    )
    shape = scene.start.shape
    assert free_space(twice, shape).directions.shape == free_space(once, shape).directions.shape
    np.testing.assert_allclose(
        held_shape(twice, scene.start.shape), held_shape(once, scene.start.shape), atol=1e-6
    )


def test_what_no_body_nearby_has_is_an_error_and_not_an_endless_search(scene):
    held = person(scene, {"waist_girth_navel": 0.0}).attributes.held
    with pytest.raises(NumericalError, match="No body near"):
        held_shape(replace(held, values=np.array([-10.0])), scene.start.shape)


def test_a_step_that_cannot_be_brought_back_is_none(scene):
    held = person(scene, {"waist_girth_navel": 0.0}).attributes.held
    space = free_space(replace(held, values=np.array([-10.0])), scene.start.shape)
    still = np.zeros(scene.start.pose.size + 3), np.zeros(len(scene.start.shape))
    assert space.moved([scene.start], [still[0]], still[1]) is None


def test_with_everything_known_the_pose_is_still_searched(scene):
    others = [name for name in body().population.names if name != "stature"]
    objective, start = begun(scene, person(scene, dict.fromkeys(others, 0.0)))
    found = minimize_gauss_newton(objective, start, max_evaluations=20, on_energies=ignore)
    assert found.candidate.total < 0.5 * objective.evaluate(start).total
    values = measured(found.candidate.shape)
    assert values == pytest.approx(measured(scene.truth.shape), abs=0.02)


def test_an_uncertain_attribute_costs_half_a_nat_at_its_standard_error(scene):
    known = person(scene, {"weight": 2.0, "hip_girth": 1.0}).attributes
    assert attribute_energy(known, scene.truth.shape) == pytest.approx(0.0, abs=1e-12)
    off = replace(known, uncertain=replace(known.uncertain, values=known.uncertain.values + [2, 0]))
    assert attribute_energy(off, scene.truth.shape) == pytest.approx(0.5)


def test_the_slopes_of_attributes_agree_with_finite_differences(scene):
    known = person(scene, {"weight": 2.0, "hip_girth": 1.0, "arm_length": 0.5}).attributes
    shape, step = 0.5 * scene.truth.shape, 1e-3
    numeric = np.stack(
        [
            (attribute_residuals(known, shape + e) - attribute_residuals(known, shape - e))
            / (2.0 * step)
            for e in step * np.eye(len(shape))
        ],
        axis=1,
    )
    np.testing.assert_allclose(attribute_slopes(known, shape), numeric, atol=2e-3)
    # The equations have its gradient beside that of everything else, along all but the height.
    space = free_space(NOTHING_KNOWN.held, shape)
    with_attributes, without = (
        joint_equations(each, each.evaluate([replace(scene.truth, shape=shape)]), space)
        for each in (of_person(scene.objective, attributes=known), scene.person)
    )
    along = np.array(
        [
            (attribute_energy(known, shape + e) - attribute_energy(known, shape - e)) / (2.0 * step)
            for e in step * np.eye(len(shape))
        ]
    )
    np.testing.assert_allclose(
        with_attributes.shared_gradient - without.shared_gradient, along[1:], rtol=1e-2, atol=1e-2
    )


@pytest.fixture(scope="module")
def held_fit(scene):
    objective, start = begun(scene, person(scene, dict.fromkeys(HELD, 0.0)))
    return objective, minimize_gauss_newton(
        objective, start, max_evaluations=100, on_energies=ignore
    )


def test_a_fit_has_the_height_and_the_attributes_it_was_given(scene, held_fit):
    _, minimum = held_fit
    found, wanted = measured(minimum.candidate.shape), measured(scene.truth.shape)
    assert minimum.converged
    assert "attributes" not in minimum.candidate.energies
    assert scene.objective.overlap(minimum.candidate.views[0]) > 0.96
    for name in ("stature", *HELD):
        assert found[name] == pytest.approx(wanted[name], abs=0.01)


def test_what_is_given_is_certain_and_makes_the_rest_more_certain(scene, held_fit):
    objective, minimum = held_fit
    errors = spreads(objective, minimum.candidate, 0.0)
    free = spreads(scene.person, minimum.candidate, 0.0)
    for name in ("stature", *HELD):
        assert errors[name] < 1e-3
    for name in ("hip_girth", "chest_girth", "thigh_girth"):
        assert 0.1 < errors[name] < 0.95 * free[name]


def test_an_uncertain_attribute_is_met_within_its_tolerance(scene):
    known = person(scene, {"weight": 1.0, "waist_girth_navel": 0.5})
    objective, start = begun(scene, known)
    found = minimize_gauss_newton(objective, start, max_evaluations=100, on_energies=ignore)
    values, wanted = measured(found.candidate.shape), measured(scene.truth.shape)
    assert values["weight"] == pytest.approx(wanted["weight"], abs=1.0)
    assert values["waist_girth_navel"] == pytest.approx(wanted["waist_girth_navel"], abs=0.5)
    assert found.candidate.energies["attributes"] < 1.0
    errors = spreads(objective, found.candidate, 0.0)
    # Known as it was told, or better where the picture knows as well.
    assert 0.3 < errors["weight"] < 1.0
    assert 0.2 < errors["waist_girth_navel"] < 0.5


@pytest.mark.slow
def test_a_given_weight_corrects_the_body_the_picture_alone_gives(scene):
    wanted = measured(scene.truth.shape)
    off: list[float] = []
    for errors in ({}, {"weight": 0.0}):
        objective, start = begun(scene, person(scene, errors))
        found = minimize_gauss_newton(objective, start, max_evaluations=100, on_energies=ignore)
        values = measured(found.candidate.shape)
        off.append(sum(abs(values[name] - wanted[name]) for name in ("hip_girth", "chest_girth")))
    assert off[1] < 0.6 * off[0]


def test_the_simplex_holds_attributes_as_well(scene):
    objective, start = begun(scene, person(scene, dict.fromkeys(HELD, 0.0)))
    found = minimize_simplex(objective, start, max_evaluations=100, on_energies=ignore)
    assert found.candidate.total < objective.evaluate(start).total
    values, wanted = measured(found.candidate.shape), measured(scene.truth.shape)
    assert not np.array_equal(found.candidate.shape, start[0].shape)
    for name in ("stature", *HELD):
        assert values[name] == pytest.approx(wanted[name], abs=0.01)


def test_an_unknown_height_spreads_all_but_what_is_held(scene, held_fit):
    objective, minimum = held_fit
    (certain,) = certainty(objective, minimum.candidate)
    covariance = shape_covariance(certain, height_variance=0.4)
    assert covariance[0, 0] == pytest.approx(0.4)
    errors = spreads(objective, minimum.candidate, 0.4)
    assert errors["stature"] > 3.0
    for name in HELD:
        assert errors[name] < 1e-3


def test_a_fit_of_somebody_of_an_unusual_height_is_less_certain(held_fit):
    (certain,) = certainty(held_fit[0], held_fit[1].candidate)
    body = certain.candidate.parameters
    tall = replace(body, shape=body.shape + (7.0 - body.shape[0]) * np.eye(len(body.shape))[0])
    unusual = replace(certain, candidate=replace(certain.candidate, parameters=tall))
    np.testing.assert_allclose(
        shape_covariance(unusual, height_variance=0.0),
        height_extrapolation(7.0) * shape_covariance(certain, height_variance=0.0),
    )


def test_an_unknown_height_leaves_uncertain_attributes_as_certain_as_they_were_told(scene):
    known = person(scene, {"weight": 1.0, "inseam": 0.5})
    objective, start = begun(scene, known)
    candidate = objective.evaluate(start)
    errors = spreads(objective, candidate, 0.4)
    assert errors["stature"] > 3.0
    # The shape answers a change of height: without that the weight alone would be 3 kg uncertain.
    assert errors["weight"] < 1.1
    assert errors["inseam"] < 0.55
