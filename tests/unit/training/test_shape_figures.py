import numpy as np
import pytest

from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import rest_vertices
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.measurement.anthropometry import measurement_values, measuring_body
from fitter.training.report.measured_people import measured_bodies

SHAPES = np.random.default_rng(2).normal(size=(3, 20))


@pytest.fixture(scope="module")
def model():
    return load_body_model(packaged_model_path("female"))


def test_whole_bodies_measure_as_the_shapes_they_are(model):
    rest = np.stack([rest_vertices(model, shape) for shape in SHAPES])
    body = measuring_body(model, ScapeEvaluator(model))
    expected = np.stack([measurement_values(body, shape) for shape in SHAPES])
    np.testing.assert_allclose(measured_bodies(model, rest), expected, atol=2e-3)
