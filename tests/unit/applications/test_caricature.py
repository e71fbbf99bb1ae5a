import numpy as np
import pytest

from fitter.applications.caricature import (
    MOST_DEVIATIONS,
    caricature_of_looks,
    caricature_of_most_unusual,
    most_unusual,
)
from fitter.body.shape_space import height_of_shape
from fitter.errors import InvalidInputError
from fitter.numerics.meshes import enclosed_volume
from fitter.parameters import BodyParameters
from tests.unit.applications.bodies import packaged


@pytest.fixture(scope="module", params=["female", "male"])
def body(request):
    return packaged(request.param)


def refusal(call) -> InvalidInputError:
    with pytest.raises(InvalidInputError) as caught:
        call()
    assert (caught.value.code, caught.value.field) == ("factor-unusable", "factor")
    return caught.value


def largest_factor(error: InvalidInputError) -> float:
    assert error.remedy == f"Send a factor from 0 to {error.largest:.2f}."
    return error.largest


def person(body, **coefficients):
    shape = np.zeros_like(body.shape)
    for name, value in coefficients.items():
        shape[int(name.removeprefix("c"))] = value
    return shape


def test_the_height_is_never_what_is_unusual():
    assert most_unusual(np.array([5.0, 0.1, -0.7, 0.6])) == 2


@pytest.mark.parametrize("factor", [0.0, 0.5, 1.0, 1.7])
def test_one_coefficient_is_multiplied_and_height_is_kept(body, factor):
    found = caricature_of_most_unusual(body.evaluator, body.shape, factor)
    k = found.coefficient
    assert k == most_unusual(body.shape)
    assert found.shape[k] == pytest.approx(factor * body.shape[k])
    others = np.delete(np.arange(len(body.shape)), [0, k])
    np.testing.assert_array_equal(found.shape[others], body.shape[others])
    height = height_of_shape(body.evaluator, found.shape)
    assert height == pytest.approx(height_of_shape(body.evaluator, body.shape), abs=2e-6)
    assert found.height_m == pytest.approx(height, abs=2e-6)


def test_a_heavy_person_gets_heavier_and_a_thin_one_thinner(body):
    def volume(shape):
        parameters = BodyParameters(
            pose=body.model.canonical_pose, translation=np.zeros(3), shape=shape
        )
        vertices = body.evaluator.body_frame_vertices(parameters)
        return enclosed_volume(vertices, body.model.triangles)

    for value in (-2.0, 2.0):
        shape = person(body, c1=value)
        more = volume(caricature_of_most_unusual(body.evaluator, shape, 1.5).shape) - volume(shape)
        axis = volume(person(body, c1=1.0)) - volume(person(body, c1=-1.0))
        assert np.sign(more) == np.sign(value * axis)
        assert abs(more) > 0.003


@pytest.mark.slow
def test_the_largest_factor_named_is_accepted_and_little_more_is_not(body):
    value = -2.5
    shape = person(body, c1=value, c4=0.5)
    largest = largest_factor(
        refusal(lambda: caricature_of_most_unusual(body.evaluator, shape, 50.0))
    )
    assert 1.2 < largest < MOST_DEVIATIONS / abs(value)
    assert caricature_of_most_unusual(body.evaluator, shape, largest).factor == largest
    refusal(lambda: caricature_of_most_unusual(body.evaluator, shape, largest + 0.1))


@pytest.mark.parametrize("factor", [-0.1, float("nan"), float("inf")])
def test_factors_that_are_no_exaggeration_are_refused(body, factor):
    refusal(lambda: caricature_of_most_unusual(body.evaluator, body.shape, factor))


def test_of_the_mean_body_nothing_can_be_exaggerated(body):
    error = refusal(
        lambda: caricature_of_most_unusual(body.evaluator, np.zeros_like(body.shape), 2.0)
    )
    assert "mean body" in error.reason


@pytest.mark.parametrize("factor", [0.0, 0.5, 1.0, 1.7])
def test_looks_are_all_coefficients_but_the_height(body, factor):
    found = caricature_of_looks(body.evaluator, body.shape, factor)
    np.testing.assert_allclose(found.shape[1:], factor * body.shape[1:])
    height = height_of_shape(body.evaluator, body.shape)
    assert height_of_shape(body.evaluator, found.shape) == pytest.approx(height, abs=2e-6)
    assert (found.before, found.after) == (
        body.shape[found.coefficient],
        factor * body.shape[found.coefficient],
    )


@pytest.mark.slow
def test_the_largest_factor_of_looks_is_accepted_and_little_more_is_not(body):
    shape = person(body, c1=2.0, c2=1.0, c3=-1.0)
    largest = largest_factor(refusal(lambda: caricature_of_looks(body.evaluator, shape, 50.0)))
    assert largest > 1.2
    assert caricature_of_looks(body.evaluator, shape, largest).factor == largest
    refusal(lambda: caricature_of_looks(body.evaluator, shape, largest + 0.1))
