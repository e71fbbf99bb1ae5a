from dataclasses import replace

import numpy as np
import pytest

from fitter.body.scape import ScapeEvaluator
from fitter.measurement.anthropometry import measure, measuring_body
from fitter.measurement.joint_measurements import joint_measurements
from tests.unit.body.synthetic_model import bar_model
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
