"""The body before any picture is looked at, on the shipped models."""

import numpy as np
import pytest

from fitter.body.model import regress
from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import shape_for_height
from fitter.errors import InvalidInputError
from fitter.fits.equipment import prepared_model
from fitter.fits.initial_body import initial_body, limb_readings
from fitter.measurement.anthropometry import measure
from fitter.parameters import BodyParameters
from fitter.pose_init.initial_pose import PoseHypothesis
from fitter.render.camera import Camera
from fitter.render.rasterizer import render
from fitter.request import Click, FitRequest, KnownMeasurement
from fitter.vocabulary.choices import Facing, Gender
from fitter.vocabulary.outcomes import FocalLengthSource
from fitter.vocabulary.points import POINT_NAMES
from tests.one_picture import changed, one_picture

CAMERA = Camera(focal_length_px=900.0, centre_x=360.0, centre_y=480.0, width=720, height=960)
HEIGHT_M = 1.7
KNOWN = {"weight": 82.0, "inseam": 82.0}


def standing_person() -> tuple[ScapeEvaluator, BodyParameters]:
    body = prepared_model(Gender.FEMALE)
    evaluator = body.operators.evaluator
    parameters = BodyParameters(
        pose=body.operators.model.canonical_pose,
        translation=np.array([0.05, 0.05, 2.6]),
        shape=shape_for_height(evaluator, HEIGHT_M),
    )
    return evaluator, parameters


@pytest.fixture(scope="module")
def request_of_standing_person() -> FitRequest:
    evaluator, parameters = standing_person()
    landmarks = evaluator.model.landmarks
    places = CAMERA.project(regress(landmarks, evaluator.vertices(parameters)))
    found = dict(zip(landmarks.names, places.tolist(), strict=True))
    return one_picture(
        image=b"",
        clicks={name: Click(x=found[name][0], y=found[name][1]) for name in POINT_NAMES},
        gender=Gender.FEMALE,
        height_m=HEIGHT_M,
        focal_length_px=CAMERA.focal_length_px,
    )


def found(request: FitRequest, **changes):
    arguments = {"width": 720, "height": 960} | changes
    (view,) = request.views
    model = prepared_model(request.person.gender)
    return initial_body(request.person, view, model, **arguments)


def test_the_outline_is_that_of_the_person_the_clicks_were_taken_from(request_of_standing_person):
    import cv2

    evaluator, parameters = standing_person()
    truth = render(evaluator.vertices(parameters), evaluator.model.triangles, CAMERA).silhouette
    initial = found(request_of_standing_person)
    filled = np.zeros(truth.shape, dtype=np.uint8)
    loops = [np.rint(loop - 0.5).astype(np.int32) for loop in initial.outline]
    cv2.fillPoly(filled, loops, (1,))
    overlap = (truth & (filled > 0)).sum() / (truth | (filled > 0)).sum()
    assert overlap > 0.93


def test_landmarks_lie_where_they_were_clicked(request_of_standing_person):
    initial = found(request_of_standing_person)
    for name, click in request_of_standing_person.views[0].clicks.items():
        assert initial.landmarks[name] == pytest.approx([click.x, click.y], abs=6.0), name
        off = np.hypot(*(initial.landmarks[name] - [click.x, click.y]))
        assert initial.residual_px[name] == pytest.approx(off, abs=1e-6)


def test_an_arm_straight_down_may_lean_either_way_and_says_so(request_of_standing_person):
    readings = {reading.limb: reading for reading in found(request_of_standing_person).limbs}
    assert set(readings) >= {"torso", "left_forearm", "right_shin"}
    for reading in readings.values():
        assert reading.ambiguous == (
            reading.alternative_nats is not None and reading.alternative_nats < 6.0
        )


def test_what_the_caller_says_of_a_limb_is_obeyed_and_not_called_ambiguous(
    request_of_standing_person,
):
    for facing in Facing:
        request = changed(request_of_standing_person, limb_facing={"left_thigh": facing})
        (reading,) = [r for r in found(request).limbs if r.limb == "left_thigh"]
        assert reading.facing is facing
        assert not reading.ambiguous


def test_the_focal_length_is_the_callers_or_assumed(request_of_standing_person):
    said = found(request_of_standing_person)
    assert (said.focal_length_source, said.assumptions) == (FocalLengthSource.CALLER, ())
    assumed = found(changed(request_of_standing_person, focal_length_px=None))
    assert assumed.focal_length_source is FocalLengthSource.ASSUMED
    assert [each.code for each in assumed.assumptions] == ["lens-assumed"]


def test_an_unknown_height_is_assumed_and_said_so(request_of_standing_person):
    initial = found(changed(request_of_standing_person, height_m=None))
    assert initial.height_m == 1.65
    assert "height-assumed" in {each.code for each in initial.assumptions}


def test_a_head_alone_is_refused(request_of_standing_person):
    (view,) = request_of_standing_person.views
    head = {n: c for n, c in view.clicks.items() if n in ("nose", "neck")}
    with pytest.raises(InvalidInputError) as caught:
        found(changed(request_of_standing_person, clicks=head))
    assert caught.value.code == "too-few-points"


def hypothesis(energy: float, **facing: Facing) -> PoseHypothesis:
    body = BodyParameters(pose=np.zeros((1, 3)), translation=np.zeros(3), shape=np.zeros(1))
    return PoseHypothesis(parameters=body, energy=energy, facing=facing)


def test_a_limb_is_ambiguous_where_a_reading_nearly_as_good_says_otherwise():
    hypotheses = [
        hypothesis(10.0, left_shin=Facing.AWAY, left_forearm=Facing.AWAY, torso=Facing.AWAY),
        hypothesis(12.0, left_shin=Facing.TOWARD, left_forearm=Facing.AWAY, torso=Facing.AWAY),
        hypothesis(30.0, left_shin=Facing.TOWARD, left_forearm=Facing.TOWARD, torso=Facing.AWAY),
    ]
    shin, forearm, torso = limb_readings(hypotheses, {})
    assert (shin.ambiguous, shin.alternative_nats) == (True, 2.0)
    assert (forearm.ambiguous, forearm.alternative_nats) == (False, 20.0)
    assert (torso.ambiguous, torso.alternative_nats) == (False, None)


def test_the_initial_body_has_the_measurements_that_are_known(request_of_standing_person):
    known = {name: KnownMeasurement(value=value) for name, value in KNOWN.items()}
    initial = found(changed(request_of_standing_person, measurements=known))
    values = {
        each.name: each.value
        for each in measure(prepared_model(Gender.FEMALE).measuring, initial.body.shape)
    }
    for name, value in KNOWN.items():
        assert values[name] == pytest.approx(value, abs=0.01)
    assert values["stature"] == pytest.approx(100.0 * HEIGHT_M, abs=0.01)
    # Height comes from the height coefficient alone; where limbs lie comes from the whole shape.
    without = found(request_of_standing_person)
    assert initial.body.shape[0] == pytest.approx(without.body.shape[0], abs=1e-4)
    assert initial.residual_px != without.residual_px
