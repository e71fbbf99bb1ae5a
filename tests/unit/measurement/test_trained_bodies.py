"""Measurements of the body models that are shipped."""

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import height_of_shape
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.measurement.anthropometry import (
    MeasuringBody,
    measure,
    measurement_jacobian,
    measurement_values,
    measuring_body,
)
from fitter.measurement.plane_cut import Plane, closed_length, hull_of, in_plane, plane_section

SURVEY = json.loads(Path(__file__).with_name("survey_means.json").read_text(encoding="utf-8"))
GENDERS = ("female", "male")


@pytest.fixture(scope="module", params=GENDERS)
def trained(request) -> tuple[str, ScapeEvaluator, MeasuringBody]:
    model = load_body_model(packaged_model_path(request.param))
    evaluator = ScapeEvaluator(model)
    return request.param, evaluator, measuring_body(model, evaluator)


@pytest.fixture
def mean_shape(trained):
    return np.zeros(len(trained[1].model.shape_basis))


def by_name(body, values):
    return dict(zip((d.about.name for d in body.definitions), values, strict=True))


def test_the_mean_body_measures_as_people_do(trained, mean_shape):
    """Within one standard deviation: the survey has soldiers, the training civilians too."""
    gender, _, body = trained
    far = {}
    for definition, value in zip(
        body.definitions, measurement_values(body, mean_shape), strict=True
    ):
        field = definition.about.survey_field
        if field is not None:
            mean, deviation = SURVEY[gender][field]
            if abs(value - mean) > deviation:
                far[definition.about.name] = (round(value, 1), mean, deviation)
    assert not far


def test_stature_is_the_one_the_height_constraint_holds(trained, mean_shape):
    _, evaluator, body = trained
    shape = mean_shape.copy()
    shape[:3] = [1.3, -0.7, 0.4]
    reported = by_name(body, measurement_values(body, shape))["stature"]
    assert reported == pytest.approx(100.0 * height_of_shape(evaluator, shape), abs=1e-3)


def test_only_the_height_axis_changes_stature(trained, mean_shape):
    _, _, body = trained
    names = [d.about.name for d in body.definitions]
    row = measurement_jacobian(body, mean_shape)[names.index("stature")]
    assert abs(row[0]) > 4.0
    assert np.abs(row[1:]).max() < 0.1


def test_girths_keep_the_order_they_have_on_people(trained, mean_shape):
    _, _, body = trained
    rng = np.random.default_rng(5)
    for _ in range(5):
        values = by_name(body, measurement_values(body, rng.normal(size=len(mean_shape))))
        assert values["waist_girth_smallest"] <= values["waist_girth_navel"] + 1e-9
        assert values["wrist_girth"] < values["forearm_girth"] < values["calf_girth"]
        assert values["ankle_girth"] < values["calf_girth"] < values["thigh_girth"]
        assert values["neck_girth"] < values["thigh_girth"] < values["hip_girth"]
        assert values["inseam"] < 0.55 * values["stature"]


def test_a_heavier_body_is_thicker_everywhere_around_the_trunk(trained, mean_shape):
    _, _, body = trained
    names = [d.about.name for d in body.definitions]
    jacobian = measurement_jacobian(body, mean_shape)
    weight = jacobian[names.index("weight")].copy()
    weight[0] = 0.0  # at constant stature
    direction = weight / np.linalg.norm(weight)
    change = by_name(body, jacobian @ direction)
    for name in ("chest_girth", "waist_girth_navel", "waist_girth_smallest", "hip_girth"):
        assert change[name] > 2.0, name
    for name in ("thigh_girth", "upper_arm_girth", "neck_girth", "calf_girth"):
        assert change[name] > 0.0, name


def test_the_jacobian_agrees_with_measuring_changed_bodies_afresh(trained, mean_shape):
    _, _, body = trained
    jacobian = measurement_jacobian(body, mean_shape)
    for index in (0, 1, 7):
        change = 0.05 * np.eye(len(mean_shape))[index]
        fresh = (measurement_values(body, change) - measurement_values(body, -change)) / 0.1
        np.testing.assert_allclose(jacobian[:, index], fresh, atol=0.05)


def test_errors_come_with_a_covariance_in_each_measurements_unit(trained, mean_shape):
    _, _, body = trained
    spread = 0.01 * np.eye(len(mean_shape))
    for measured in measure(body, mean_shape, shape_covariance=spread):
        assert measured.standard_error is not None
        assert 0.0 < measured.standard_error < 5.0, measured.name


def test_a_girth_is_the_same_wherever_the_body_stands(trained, mean_shape):
    _, _, body = trained
    vertices = body.canonical.at(mean_shape)
    region = body.regions["chest_girth"]
    level = Plane(point=np.array([0.0, 0.35, 0.0]), normal=np.array([0.0, 1.0, 0.0]))
    rotation = Rotation.from_rotvec([0.7, -1.9, 0.4]).as_matrix()
    moved = Plane(point=rotation @ level.point + [1, 2, 3], normal=rotation @ level.normal)

    def girth(points, plane):
        lines = plane_section(points, region, plane)
        flat = in_plane(np.concatenate([line.points for line in lines]), plane)
        return closed_length(hull_of(flat))

    turned = vertices @ rotation.T + [1.0, 2.0, 3.0]
    assert girth(turned, moved) == pytest.approx(girth(vertices, level), abs=1e-7)


@pytest.mark.parametrize("name", ["chest_girth", "waist_girth_navel", "hip_girth"])
def test_the_trunks_tape_does_not_take_in_the_arms(trained, mean_shape, name):
    _, _, body = trained
    breadth = by_name(body, measurement_values(body, mean_shape))[name] / np.pi
    span = 100.0 * np.ptp(body.canonical.at(mean_shape)[:, 0])
    assert breadth < 0.35 * span
