import json
from dataclasses import replace

import numpy as np
import pytest

from fitter.body.scape import ScapeEvaluator
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.errors import NumericalError
from fitter.measurement.anthropometry import (
    UNEXPLAINED_KEY,
    UNEXPLAINED_PATH,
    affine_body,
    measure,
    measurement_jacobian,
    measurement_values,
    measuring_body,
    unexplained,
)
from fitter.measurement.definitions import (
    Girth,
    Height,
    Length,
    Mass,
    Orientation,
    Selection,
    Unit,
    load_definitions,
)
from fitter.numerics.meshes import enclosed_volume
from fitter.parameters import BodyParameters
from tests.unit.body.synthetic_model import bar_model
from tests.unit.measurement.made_up import about


def bar_girth(name, *, fractions, selection=Selection.LARGEST):
    return Girth(
        about=about(name),
        start=("joint:bottom",),
        end=("crown",),
        origin=None,
        fractions=fractions,
        selection=selection,
        orientation=Orientation.LEVEL,
        parts=("bottom", "middle", "top"),
        around_axis=True,
    )


DEFINITIONS = (
    Height(about=about("stature"), point=("crown",)),
    Mass(about=about("weight", Unit.KILOGRAMS), density_kg_per_m3=1000.0),
    Length(about=about("length"), path=(("joint:bottom",), ("joint:middle",), ("joint:top",))),
    bar_girth("girth", fractions=(0.37, 0.37)),
    bar_girth("largest", fractions=(0.1, 0.9)),
)
SHAPE = np.array([0.7, -0.4])


@pytest.fixture(scope="module")
def bar():
    model = bar_model()
    # Bent, so that the largest girth of a level cut lies somewhere within the range.
    pose = np.array([[0.0, 0.0, 0.0], [0.5, 0.1, 0.2], [-0.3, 0.0, 0.1]])
    return replace(model, canonical_pose=pose)


@pytest.fixture(scope="module")
def evaluator(bar):
    return ScapeEvaluator(bar)


@pytest.fixture(scope="module")
def body(bar, evaluator):
    return measuring_body(bar, evaluator, DEFINITIONS)


def test_a_body_in_one_pose_is_affine_in_its_shape(bar, evaluator):
    affine = affine_body(evaluator, bar.canonical_pose)
    direct = evaluator.body_frame_vertices(
        BodyParameters(pose=bar.canonical_pose, translation=np.zeros(3), shape=3 * SHAPE)
    )
    np.testing.assert_allclose(affine.at(3 * SHAPE), direct, atol=1e-9)


def test_weight_is_the_volume_in_litres(bar, body):
    weight = measure(body, SHAPE)[1]
    assert (weight.name, weight.unit) == ("weight", "kg")
    volume = enclosed_volume(body.canonical.at(SHAPE), bar.triangles)
    assert weight.value == pytest.approx(1000.0 * volume, rel=1e-12)


def test_stature_is_taken_in_the_standing_pose_not_in_the_bent_one(bar, evaluator, body):
    standing = affine_body(evaluator, bar.standing_pose).at(SHAPE)
    assert measure(body, SHAPE)[0].value == pytest.approx(100 * np.ptp(standing[:, 1]), abs=1e-6)
    assert 100 * np.ptp(body.canonical.at(SHAPE)[:, 1]) < measure(body, SHAPE)[0].value - 5.0


def test_values_come_in_the_order_of_the_definitions(body):
    measured = measure(body, SHAPE)
    assert [m.name for m in measured] == [d.about.name for d in DEFINITIONS]
    np.testing.assert_allclose([m.value for m in measured], measurement_values(body, SHAPE))


def test_the_jacobian_agrees_with_measuring_changed_bodies_afresh(body):
    jacobian = measurement_jacobian(body, SHAPE)
    step = 0.02
    for index in range(len(SHAPE)):
        change = step * np.eye(len(SHAPE))[index]
        ahead, behind = (measurement_values(body, SHAPE + s * change) for s in (1.0, -1.0))
        fresh = (ahead - behind) / (2 * step)
        np.testing.assert_allclose(jacobian[:-1, index], fresh[:-1], rtol=1e-5, atol=1e-4)
        # Measured afresh, the largest girth also finds another place: second order in the step,
        # and this bar has flat facets.
        np.testing.assert_allclose(jacobian[-1, index], fresh[-1], rtol=5e-3, atol=1e-2)


def test_the_standard_error_is_that_of_the_shape_carried_through_the_jacobian(body):
    spread = np.array([[0.09, 0.01], [0.01, 0.04]])
    jacobian = measurement_jacobian(body, SHAPE)
    errors = [m.standard_error for m in measure(body, SHAPE, shape_covariance=spread)]
    for row, error in zip(jacobian, errors, strict=True):
        # Standard errors are taken from one-sided differences, this Jacobian from central ones.
        assert error == pytest.approx(np.sqrt(row @ spread @ row), rel=3e-4)


def test_without_a_covariance_no_standard_error_is_claimed(body):
    assert all(m.standard_error is None for m in measure(body, SHAPE))


def test_what_is_held_does_not_vary_and_the_others_vary_as_before(body):
    spread = np.array([[0.09, 0.01], [0.01, 0.04]])
    unsure = replace(body, unexplained=np.full(len(body.definitions), 2.0))
    free = measure(unsure, SHAPE, shape_covariance=spread)
    first, *others = measure(unsure, SHAPE, shape_covariance=spread, held=(free[0].name,))
    assert free[0].standard_error
    assert first.standard_error == 0.0
    assert others == list(free[1:])


def test_a_tape_that_misses_the_body_is_an_error_that_names_it(bar, evaluator):
    missing = (*DEFINITIONS, bar_girth("beyond", fractions=(1.5, 1.5)))
    with pytest.raises(NumericalError, match="Not finite: beyond"):
        measure(measuring_body(bar, evaluator, missing), SHAPE)


def test_what_the_shapes_leave_unexplained_is_added_to_what_is_not_given(body):
    covariance = np.eye(len(SHAPE))
    plain = measure(body, SHAPE, shape_covariance=covariance)
    first, *others = plain
    unsure = replace(body, unexplained=np.full(len(plain), 2.0))
    told, *inferred = measure(unsure, SHAPE, shape_covariance=covariance, given=(first.name,))
    assert others
    assert told.standard_error == first.standard_error
    for before, after in zip(others, inferred, strict=True):
        assert before.standard_error is not None
        assert after.standard_error == pytest.approx(np.hypot(before.standard_error, 2.0))


NAMES = [definition.about.name for definition in load_definitions()]


@pytest.mark.parametrize("gender", ["female", "male"])
def test_every_measurement_of_the_packaged_models_leaves_something_unexplained(gender):
    found = unexplained(load_body_model(packaged_model_path(gender)), NAMES)
    assert found.shape == (len(NAMES),)
    assert (found > 0.1).all()
    assert (found < 2.5).all()


@pytest.mark.parametrize("gender", ["female", "male"])
def test_what_was_found_since_training_agrees_with_what_the_model_says(gender):
    model = load_body_model(packaged_model_path(gender))
    said = model.header[UNEXPLAINED_KEY]
    since = json.loads(UNEXPLAINED_PATH.read_text())[model.checksum]
    for name, value in said.items():
        assert since[name] == pytest.approx(value, abs=0.005), name


def test_the_models_own_word_counts_before_what_was_found_since():
    model = load_body_model(packaged_model_path("female"))
    other = replace(model, header=model.header | {UNEXPLAINED_KEY: {"hip_girth": 7.0}})
    hip, waist = unexplained(other, ["hip_girth", "waist_girth_navel"])
    assert hip == 7.0
    assert 0.0 < waist < 2.0


def test_nothing_is_said_of_a_model_that_nobody_knows():
    model = load_body_model(packaged_model_path("female"))
    other = replace(model, header={"checksum": "unknown"})
    assert np.array_equal(unexplained(other, NAMES), np.zeros(len(NAMES)))
