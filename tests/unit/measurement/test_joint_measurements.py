"""Measurements with their joint errors, and points of the skin."""

from dataclasses import replace

import numpy as np
import pytest

from fitter.body.model import regress
from fitter.body.scape import ScapeEvaluator
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.errors import DefinitionError
from fitter.measurement.anthropometry import measure, measuring_body
from fitter.measurement.definitions import JOINT_PREFIX, load_definitions, points_of
from fitter.measurement.joint_measurements import joint_measurements
from fitter.measurement.skin_points import SkinPoint, load_skin_points, skin_rows
from tests.unit.body.synthetic_model import bar_model
from tests.unit.measurement.solids import tube
from tests.unit.measurement.test_anthropometry import DEFINITIONS, SHAPE

COVARIANCE = np.array([[0.3, 0.1], [0.1, 0.2]])


@pytest.fixture(scope="module")
def body():
    model = bar_model()
    measuring = measuring_body(model, ScapeEvaluator(model), DEFINITIONS)
    return replace(measuring, unexplained=np.array([0.5, 0.0, 0.2, 1.0, 2.0]))


def test_standard_errors_are_those_of_single_measurements(body):
    told = {"given": ("length",), "held": ("stature",)}
    together = joint_measurements(body, SHAPE, shape_covariance=COVARIANCE, **told)
    alone = measure(body, SHAPE, shape_covariance=COVARIANCE, **told)
    assert together.names == tuple(each.name for each in alone)
    assert together.units == tuple(each.unit for each in alone)
    np.testing.assert_allclose(together.values, [each.value for each in alone])
    np.testing.assert_allclose(
        together.standard_errors, [each.standard_error for each in alone], rtol=1e-3
    )
    assert together.given == ("length",)


def test_what_is_unexplained_of_one_measurement_says_nothing_of_another(body):
    plain = replace(body, unexplained=np.zeros(5))
    one, other = (
        joint_measurements(each, SHAPE, shape_covariance=COVARIANCE).covariance
        for each in (body, plain)
    )
    np.testing.assert_allclose(one - other, np.diag(body.unexplained**2), atol=1e-9)


def test_what_is_held_goes_along_with_nothing(body):
    held = joint_measurements(body, SHAPE, shape_covariance=COVARIANCE, held=("girth",))
    row = held.names.index("girth")
    assert np.abs(held.covariance[row]).max() == 0.0
    assert np.abs(held.covariance[:, row]).max() == 0.0


def test_measurements_are_chosen_by_name_in_the_order_asked_for(body):
    everything = joint_measurements(body, SHAPE, shape_covariance=COVARIANCE, given=("girth",))
    chosen = everything.of(("girth", "stature"))
    assert (chosen.names, chosen.units) == (("girth", "stature"), ("cm", "cm"))
    assert chosen.covariance[0, 1] == everything.covariance[3, 0]
    assert chosen.values[1] == everything.values[0]
    assert chosen.given == ("girth",)


def place(*, direction, level=None, origin=("middle",)):
    return SkinPoint(
        name="skin:place", meaning="Here.", origin=origin, level=level, direction=direction
    )


KNOWN = {"middle": np.array([0.0, 0.5, 0.0]), "low": np.array([7.0, 0.1, 7.0])}


@pytest.fixture
def cylinder():
    return tube(radius=0.2, height=1.0)


def test_a_place_lies_where_the_ray_leaves_the_skin(cylinder):
    rows = skin_rows([place(direction=(0.0, 0.0, -3.0))], KNOWN, *cylinder)
    (point,) = regress(rows, cylinder[0])
    assert point == pytest.approx([0.0, 0.5, -0.2], abs=1e-3)
    assert rows.weights.sum() == pytest.approx(1.0)
    assert (rows.weights >= -1e-9).all()


def test_a_ray_may_start_at_another_height(cylinder):
    found = skin_rows([place(direction=(1.0, 0.0, 0.0), level=("low",))], KNOWN, *cylinder)
    assert regress(found, cylinder[0])[0] == pytest.approx([0.2, 0.1, 0.0], abs=1e-3)


def test_a_ray_starts_amid_its_points(cylinder):
    known = {**KNOWN, "other": np.array([0.1, 0.3, 0.0])}
    found = skin_rows(
        [place(direction=(0.0, 0.0, 1.0), origin=("middle", "other"))], known, *cylinder
    )
    assert regress(found, cylinder[0])[0, :2] == pytest.approx([0.05, 0.4], abs=1e-9)


def test_a_place_moves_with_the_skin_around_it(cylinder):
    vertices, triangles = cylinder
    rows = skin_rows([place(direction=(0.3, 0.1, 1.0))], KNOWN, vertices, triangles)
    before, after = regress(rows, vertices), regress(rows, vertices * [2.0, 1.0, 3.0] + 1.0)
    assert after == pytest.approx(before * [2.0, 1.0, 3.0] + 1.0)


def test_a_ray_that_meets_no_skin_is_an_error_that_names_the_place(cylinder):
    known = {"middle": np.array([9.0, 0.5, 0.0])}
    with pytest.raises(DefinitionError, match="skin:place: the ray from middle meets no skin"):
        skin_rows([place(direction=(1.0, 0.0, 0.0))], known, *cylinder)


@pytest.mark.parametrize("gender", ["female", "male"])
def test_every_place_stands_on_landmarks_that_the_models_have(gender):
    model = load_body_model(packaged_model_path(gender))
    known = {*model.landmarks.names, *(JOINT_PREFIX + part for part in model.part_names)}
    for point in load_skin_points().values():
        assert set(point.needs) <= known, point.name
        assert point.meaning.endswith(".")


def test_every_place_is_used():
    used = {name for definition in load_definitions() for name in points_of(definition)}
    assert set(load_skin_points()) <= used
