"""Bodies and initial poses over HTTP: answered at once, refused by field, away for a moment."""

import pytest

from api_schemas.questions import BodyEstimate, InitialPose
from tests.integration.service.fake_answers import GLB
from tests.integration.service.harness import (
    POINTS,
    REQUEST,
    Machine,
    Service,
    eventually,
    running_service,
)
from tests.integration.service.test_bad_input import checked

SIZE = {"width": 640, "height": 480}
SUBJECT = {"gender": "male", "height_m": 1.8, "points": POINTS}
POSE = SUBJECT | {"image_size": SIZE}


@pytest.fixture(autouse=True, scope="module")
def _ready(service: Service):
    eventually(
        lambda: service.client.post("/v1/bodies", json={"gender": "male"}).status_code == 200,
        what="the estimator answers",
    )


def test_a_body_comes_with_its_measurements(service: Service):
    answer = service.client.post("/v1/bodies", json={"gender": "female", "height_m": 1.62})
    estimate = BodyEstimate.model_validate_json(answer.content)
    assert (estimate.gender, estimate.height_m) == ("female", 1.62)
    assert estimate.measurements


def test_a_body_s_file_is_the_answer_where_it_is_asked_for(service: Service):
    alone = service.client.post("/v1/bodies?format=glb", json={"gender": "male"})
    assert alone.headers["content-type"] == "model/gltf-binary"
    assert alone.content == GLB


@pytest.mark.parametrize(
    ("body", "field", "code"),
    [
        ({}, "gender", "missing"),
        ({"gender": "male", "height_m": 170}, "height_m", "out-of-range"),
        ({"gender": "male", "measurements": {"bust": 90}}, "measurements.bust", "unknown-value"),
        ({"gender": "male", "shoe": 42}, "shoe", "unknown-field"),
    ],
)
def test_a_body_that_cannot_be_is_refused_by_field(service: Service, body, field, code):
    problem = checked(service.client.post("/v1/bodies", json=body), 422)
    assert (problem.field, problem.code) == (field, code)


@pytest.mark.parametrize("path", ["/v1/bodies", "/v1/initial-poses"])
def test_what_is_no_json_is_told(service: Service, path):
    json = {"Content-Type": "application/json; charset=utf-8"}
    malformed = checked(service.client.post(path, content=b"{", headers=json), 400)
    assert (malformed.field, malformed.code) == ("body", "invalid-json")
    checked(service.client.post(path, content=b'{"gender": "male"}'), 415)
    checked(service.client.post(path, content=b" " * 1_000_001, headers=json), 413)


def test_an_initial_pose_follows_from_clicks_and_the_picture_s_size(service: Service):
    pose = InitialPose.model_validate_json(
        service.client.post("/v1/initial-poses", json=POSE).content
    )
    assert (pose.camera.width, pose.camera.height) == (640, 480)
    assert set(pose.residual_px) == set(POINTS)


def test_detectors_points_reach_the_estimator_by_name(service: Service):
    detected = [[100.0 + 10.0 * n, 20.0 * n, 2] for n in range(17)]
    request = {"gender": "male", "points": detected, "image_size": SIZE}
    pose = service.client.post("/v1/initial-poses", json=request)
    assert {"nose", "left_wrist", "right_ankle"} <= set(pose.json()["residual_px"])


@pytest.mark.parametrize(
    ("changes", "field", "code"),
    [
        ({"image_size": None}, "image_size", "missing"),
        ({"image_size": {"width": 90_000, "height": 90_000}}, "image_size", "image-too-large"),
        ({"image_size": {"width": 100, "height": 100}}, "points.nose", "point-outside-image"),
        ({"points": {"nose": [1, 1]}}, "points", "too-few-points"),
    ],
)
def test_an_initial_pose_that_cannot_be_is_refused_by_field(service: Service, changes, field, code):
    request = {name: value for name, value in (POSE | changes).items() if value is not None}
    problem = checked(service.client.post("/v1/initial-poses", json=request), 422)
    assert (problem.field, problem.code) == (field, code)


def test_a_fault_and_a_crash_are_told_and_leave_the_service_up(service: Service):
    for script in ("fault", "segfault"):
        answer = service.client.post(
            "/v1/bodies", json={"gender": "male", "measurements": {script: 1}}
        )
        assert checked(answer, 500).code == "estimator-failed"
    eventually(
        lambda: service.client.post("/v1/bodies", json={"gender": "male"}).status_code == 200,
        what="the next estimator answers",
    )


def test_without_an_estimator_the_service_says_so_and_takes_fits(tmp_path):
    with running_service(Machine(tmp_path), api_only=True, estimator="broken") as service:
        answer = service.client.post("/v1/bodies", json={"gender": "male"})
        assert checked(answer, 503).code == "estimator-unavailable"
        assert int(answer.headers["Retry-After"]) > 0
        accepted = service.post(request=REQUEST | {"weight_kg": 80.0})
        assert accepted.status_code == 202
