"""Measurements of the body models that are shipped."""

import numpy as np
import pytest
from scipy.spatial import KDTree
from scipy.spatial.transform import Rotation

from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import height_of_shape
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.measurement.anthropometry import (
    MeasuringBody,
    measurement_jacobian,
    measurement_values,
    measuring_body,
    tape_lines,
)
from fitter.measurement.definitions import BackContour, Contour, Girth, Height
from fitter.measurement.plane_cut import Plane, closed_length, plane_section
from fitter.measurement.taking import girth_axis, girths_of
from fitter.measurement.tape import girth_at_m, girth_tape
from fitter.population.body_estimate import estimate_body
from fitter.population.conditional_shape import measured_population
from fitter.request import KnownMeasurement
from fitter.training.report.survey_comparison import load_moments, packaged_moments_path
from tests.unit.measurement.plain_hull import hull_of, in_plane
from tests.unit.measurement.plain_tape import plain_tape

GENDERS = ("female", "male")

OTHER_THAN_THE_SURVEYS = {"ankle_height"}
"""The mesh's outer ankle is no ankle bone: 1 cm, of which the survey's people vary by half."""

OVER_THE_SEAT = {"back_rise", "crotch_length"}

LONGEST_EDGE_M = 0.025
"""No point of the mesh is farther from a vertex, but where a tape's slope at its end is limited."""


@pytest.fixture(scope="module", params=GENDERS)
def trained(request) -> tuple[str, ScapeEvaluator, MeasuringBody]:
    model = load_body_model(packaged_model_path(request.param))
    evaluator = ScapeEvaluator(model)
    return request.param, evaluator, measuring_body(model, evaluator)


@pytest.fixture
def mean_shape(trained):
    return np.zeros(len(trained[1].model.shape_basis))


@pytest.fixture
def some_shape(mean_shape):
    return 1.2 * np.random.default_rng(4).normal(size=len(mean_shape))


def by_name(body, values):
    return dict(zip((d.about.name for d in body.definitions), values, strict=True))


def test_a_body_of_the_surveys_size_measures_as_its_people_do(trained):
    """Within 1.2 standard deviations: bodies of the survey's mean stature and weight."""
    gender, _, body = trained
    moments = load_moments(packaged_moments_path(), gender)
    survey = dict(zip(moments.names, moments.mean, strict=True))
    known = {
        "stature": KnownMeasurement(value=survey["stature"]),
        "weight": KnownMeasurement(value=survey["weightkg"]),
    }
    estimate = estimate_body(measured_population(body), known)
    far = {}
    for definition, each in zip(body.definitions, estimate.measurements, strict=True):
        fields, share = definition.about.survey.fields, definition.about.survey.share
        if fields and definition.about.name not in OTHER_THAN_THE_SURVEYS:
            (mean,), ((variance,),) = moments.of([dict.fromkeys(fields, share)])
            if abs(each.value - mean) > 1.2 * np.sqrt(variance):
                far[definition.about.name] = (each.value, mean, np.sqrt(variance))
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


def test_measurements_keep_the_order_they_have_on_people(trained, mean_shape):
    gender, _, body = trained
    rng = np.random.default_rng(8)
    for _ in range(10):
        values = by_name(body, measurement_values(body, rng.normal(size=len(mean_shape))))

        def rise(*names, values=values):
            """Whether the measurements are in ascending order."""
            found = [values[name] for name in names]
            return found == sorted(found)

        if gender == "female":
            assert rise("under_bust_girth", "chest_girth")
        assert rise("waist_girth_navel", "abdomen_girth")
        assert rise("wrist_girth", "elbow_girth", "armscye_girth")
        assert rise("neck_girth", "neck_base_girth")
        assert rise("ankle_girth", "knee_girth", "lower_thigh_girth", "mid_thigh_girth")
        assert rise("shoulder_breadth", "back_shoulder_width")
        assert rise("upper_arm_length", "arm_length", "sleeve_length", "span")
        assert rise("ankle_height", "knee_height", "inseam", "hip_height", "waist_height")
        assert rise("waist_height", "chest_height", "shoulder_height", "cervicale_height")
        assert rise("armpit_height", "shoulder_height", "stature")
        assert rise("inseam", "outseam")
        assert rise("waist_depth", "waist_breadth")
        for girth in ("chest", "hip"):
            assert rise(f"{girth}_depth", f"{girth}_breadth", f"{girth}_girth")


def test_a_crotch_length_is_its_two_rises(trained, some_shape):
    values = by_name(trained[2], measurement_values(trained[2], some_shape))
    both = values["front_rise"] + values["back_rise"]
    assert values["crotch_length"] == pytest.approx(both, abs=1e-9)
    heights = values["waist_height"] - values["inseam"]
    assert values["body_rise"] == pytest.approx(heights, abs=1e-9)


def test_tapes_touch_the_skin_wherever_they_bend(trained, some_shape):
    """Between two touches a tape is straight, and a part of the skin lies below it."""
    _, _, body = trained
    skin = KDTree(body.canonical.at(some_shape))
    lines = tape_lines(body, some_shape)
    for definition in body.definitions:
        if isinstance(definition, Girth | Contour | BackContour):
            touches = lines[definition.about.name]
            if definition.about.name in OVER_THE_SEAT | {"sleeve_length"}:
                # The seat is the middle between both buttocks, elbow and wrist lie inside the arm.
                continue
            distances, _ = skin.query(touches)
            assert distances.max() < LONGEST_EDGE_M, definition.about.name


def test_compiled_girths_are_those_of_single_steps(trained, some_shape):
    _, _, body = trained
    vertices = body.canonical.at(some_shape)
    points = dict(zip(body.points.names, body.canonical_points.at(some_shape), strict=True))
    for name, definition in girths_of(body.definitions).items():
        axis = girth_axis(definition, points)
        for fraction in np.linspace(*definition.fractions, 5):
            cut = (definition, body.regions[name], vertices, *axis, fraction)
            plain, tape = plain_tape(*cut), girth_tape(*cut)
            assert plain is not None
            assert tape is not None
            np.testing.assert_array_equal(tape.edges, plain.edges)
            assert girth_at_m(*cut) == pytest.approx(closed_length(plain.points), rel=1e-12)


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


def test_the_lines_of_tapes_are_as_long_as_what_is_measured(trained, some_shape):
    """Heights stand apart: they are taken in the standing pose, whose legs are straight down."""
    _, _, body = trained
    measured = by_name(body, measurement_values(body, some_shape))
    lines = tape_lines(body, some_shape)
    heights = {d.about.name for d in body.definitions if isinstance(d, Height)}
    assert set(lines) == set(measured) - {"weight"}
    for name, line in lines.items():
        length_cm = 100.0 * np.linalg.norm(np.diff(line, axis=0), axis=1).sum()
        tolerance = 1.5 if name in heights else 1e-6
        assert length_cm == pytest.approx(measured[name], abs=tolerance), name


@pytest.mark.parametrize("name", ["chest_girth", "waist_girth_navel", "hip_girth"])
def test_the_trunks_tape_does_not_take_in_the_arms(trained, mean_shape, name):
    _, _, body = trained
    breadth = by_name(body, measurement_values(body, mean_shape))[name] / np.pi
    span = 100.0 * np.ptp(body.canonical.at(mean_shape)[:, 0])
    assert breadth < 0.35 * span


def test_no_measurement_jumps_where_shape_changes_a_little(trained, mean_shape):
    """A plane that passes from triangle to triangle, or a scrap of an arm that leaves it."""
    _, _, body = trained
    rng = np.random.default_rng(1)
    for _ in range(20):
        shape, change = 1.3 * rng.normal(size=(2, len(mean_shape)))
        change *= 0.02 / np.linalg.norm(change)
        before, between, after = (
            measurement_values(body, shape + step * change) for step in (0.0, 1.0, 2.0)
        )
        assert np.abs(after - 2.0 * between + before).max() < 0.05
