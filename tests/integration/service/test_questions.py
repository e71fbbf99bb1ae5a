"""Bodies, initial poses and proposed points over HTTP: asked, refused by field, told."""

import base64
import json
import os
from collections.abc import Mapping
from pathlib import Path

import httpx
import pytest

from api_schemas.fit import FitRequest
from api_schemas.points import Point
from api_schemas.questions import BodyEstimate, InitialPose, PointsProposal
from tests.integration.service.fake_answers import MASK
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import (
    CHANGED_PYTHON,
    POINTS,
    REQUEST,
    Machine,
    Service,
    eventually,
    running_service,
    said_of_view,
)
from tests.integration.service.test_bad_input import checked

SIZE = {"width": 640, "height": 480}
SUBJECT = {"gender": "male", "height_m": 1.8, "points": POINTS}
POSE = SUBJECT | {"image_size": SIZE}


def test_a_body_comes_with_its_measurements(service: Service):
    answer = service.client.post("/v1/bodies", json={"gender": "female", "height_m": 1.62})
    estimate = BodyEstimate.model_validate_json(answer.content)
    assert (estimate.gender, estimate.height_m) == ("female", 1.62)
    assert estimate.measurements


@pytest.mark.parametrize(
    ("body", "field", "code"),
    [
        ({}, "gender", "missing"),
        ({"gender": "male", "measurements": {"bust": 90}}, "measurements.bust", "unknown-value"),
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


AUTO: Mapping[str, object] = REQUEST | {"views": [{}]}


@pytest.fixture(autouse=True, scope="module")
def _ready(service: Service):
    eventually(lambda: asked(service).status_code == 200, what="the estimator answers")


def asked(
    service: Service, script: dict[str, object] | None = None, *, request: object = None
) -> httpx.Response:
    """Ask of a picture that comes along."""
    return service.client.post(
        "/v1/points",
        files={"image": ("picture.png", scripted_image(script), "image/png")},
        data={} if request is None else {"request": json.dumps(request)},
    )


def test_points_of_a_picture_can_be_sent_as_points_of_a_fit(service: Service):
    answer = asked(service)
    proposal = PointsProposal.model_validate_json(answer.content)
    assert (proposal.person, len(proposal.persons)) == (0, 1)
    assert (proposal.image_size.width, proposal.image_size.height) == (640, 480)
    assert proposal.mask is None
    assert answer.headers["cache-control"] == "no-store"
    for sent in answer.json()["points"].values():
        assert Point.model_validate_json(json.dumps(sent)).source == "proposal"
    mixed = {**POINTS, **answer.json()["points"]}
    fit = service.post(request=REQUEST | said_of_view(points=mixed))
    assert fit.status_code == 202, fit.text
    understood = service.client.get(fit.json()["links"]["request"]).json()
    points = understood["views"][0]["points"]
    assert points["nose"] == answer.json()["points"]["nose"]
    assert points["left_hip"]["source"] == "click"


def test_nobody_is_an_answer_too(service: Service):
    proposal = PointsProposal.model_validate_json(
        asked(service, {"people": 0}, request={"mask": True}).content
    )
    assert (proposal.persons, proposal.person, proposal.points) == ((), None, {})
    assert proposal.mask is None
    assert not proposal.usable
    assert [each.code for each in proposal.findings] == ["nobody-found"]


def test_a_picture_is_checked_with_what_is_said_of_it(service: Service):
    said = {"view": "side", "points": POINTS, "focal_length_px": 900.0}
    answer = PointsProposal.model_validate_json(asked(service, request=said).content)
    assert (answer.usable, answer.findings) == (True, ())
    assert (answer.seen_from, answer.lean_deg, answer.distance_m) == ("side", len(POINTS), 900.0)


def test_known_points_may_be_rows_and_few(service: Service):
    said = {"points": [[100.0, 50.0, 0.9]] * 17}
    assert asked(service, request=said).json()["lean_deg"] == 17.0
    one = asked(service, request={"points": {"nose": [100, 50]}})
    assert one.json()["lean_deg"] == 1.0


def test_one_of_several_people_can_be_chosen_and_their_mask_had(service: Service):
    two = {"people": 2}
    answer = asked(service, two, request={"person": 1, "mask": True}).json()
    assert (answer["person"], answer["points"]["nose"]["x"]) == (1, 11.0)
    assert base64.b64decode(answer["mask"]) == MASK
    problem = checked(asked(service, two, request={"person": 2}), 422)
    assert (problem.field, problem.code) == ("person", "person-unknown")


def test_an_uploaded_picture_is_asked_by_its_id(service: Service):
    upload = service.client.post(
        "/v1/images", files={"image": ("p.png", scripted_image({"people": 3}), "image/png")}
    )
    question = {"image_id": upload.json()["id"], "person": 2}
    answer = service.client.post("/v1/points", json=question)
    assert (answer.json()["person"], len(answer.json()["persons"])) == (2, 3)
    unknown = service.client.post("/v1/points", json={"image_id": "0" * 64})
    problem = checked(unknown, 422)
    assert (problem.field, problem.code) == ("image_id", "unknown-image")


@pytest.mark.parametrize(
    ("request_part", "status", "field", "code"),
    [
        ({"person": -1}, 422, "person", "out-of-range"),
        ({"persons": 1}, 422, "persons", "unknown-field"),
        ({"points": {"nose": [641, 5]}}, 422, "points.nose", "point-outside-image"),
    ],
)
def test_a_question_that_cannot_be_is_refused_by_field(
    service: Service, request_part, status, field, code
):
    problem = checked(asked(service, request=request_part), status)
    assert (problem.field, problem.code) == (field, code)


def test_what_is_no_question_is_told(service: Service):
    post = service.client.post
    checked(post("/v1/points", content=b"GIF89a", headers={"Content-Type": "image/gif"}), 415)
    missing = checked(post("/v1/points", files={"request": ("r", b"{}")}), 422)
    assert (missing.field, missing.code) == ("image_id", "missing")
    mask = {"image": ("p.png", scripted_image()), "mask": ("m.png", scripted_image())}
    assert checked(post("/v1/points", files=mask), 422).field == "mask"
    text = checked(post("/v1/points", files={"image": ("p.png", b"text")}), 415)
    assert (text.field, text.code) == ("image", "not-an-image")
    large = {"image": ("p.png", scripted_image(width=10_000, height=10_000))}
    assert checked(post("/v1/points", files=large), 422).code == "image-too-large"
    broken = {"image": ("p.png", scripted_image()), "request": ("r", b"{")}
    assert checked(post("/v1/points", files=broken), 400).field == "request"


def test_a_picture_that_ends_its_estimator_leaves_the_service_up(service: Service):
    assert checked(asked(service, {"segfault": True}), 500).code == "estimator-failed"
    eventually(lambda: asked(service).status_code == 200, what="the next estimator answers")


def test_a_detector_that_the_estimator_cannot_load_is_told(service: Service):
    told = checked(asked(service, {"no_detector": True}), 404)
    assert told.code == "detector-not-installed"
    points = asked(service, {"no_detector": True}, request={"points": POINTS})
    assert points.status_code == 200


def test_a_fit_whose_points_are_to_be_proposed_is_understood_so(service: Service):
    fit = service.post(request=dict(AUTO))
    assert fit.status_code == 202, fit.text
    path = fit.headers["Location"]
    assert service.ended(path)["state"] == "succeeded"
    options = FitRequest.model_validate_json(service.client.get(f"{path}/request").content)
    assert options.views[0].points == "auto"


def test_few_points_are_enough_where_the_others_are_proposed(service: Service):
    one = {"points": {"left_knee": [362.0, 350.0]}}
    alone, completed = (
        REQUEST | said_of_view(**one, complete_points=each) for each in (False, True)
    )
    assert checked(service.post(request=alone), 422).code == "too-few-points"
    fit = service.post(request=completed)
    assert fit.status_code == 202, fit.text
    outside = said_of_view(points={"left_knee": [641.0, 350.0]}, complete_points=True)
    problem = checked(service.post(request=REQUEST | outside), 422)
    assert (problem.field, problem.code) == ("views.0.points.left_knee", "point-outside-image")


def test_an_initial_pose_has_no_picture_to_propose_points_of(service: Service):
    size = {"image_size": {"width": 640, "height": 480}}
    asked = {"gender": "male", "points": "auto", **size}
    problem = checked(service.client.post("/v1/initial-poses", json=asked), 422)
    assert problem.field == "points"


def test_without_a_detector_points_are_not_proposed_and_all_else_works(tmp_path: Path, monkeypatch):
    monkeypatch.setenv("PYTHON_LACKS", "ai_edge_litert")
    monkeypatch.setenv("PYTHONPATH", str(CHANGED_PYTHON), prepend=os.pathsep)
    with running_service(Machine(tmp_path), api_only=True) as service:
        told = checked(asked(service), 404)
        assert told.code == "detector-not-installed"
        assert "pip install" in told.remedy
        for changes, field in (
            ({"points": "auto"}, "views.0.points"),
            ({"complete_points": True}, "views.0.complete_points"),
        ):
            refused = checked(service.post(request=REQUEST | said_of_view(**changes)), 422)
            assert (refused.field, refused.code) == (field, "detector-not-installed")
        assert service.post().status_code == 202
