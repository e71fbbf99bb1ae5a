"""Bodies, initial poses and proposed points over HTTP: asked, refused by field, told."""

import json
import os
from pathlib import Path

import httpx
import pytest

from api_schemas.points import Point
from api_schemas.questions import PointsProposal
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


@pytest.mark.parametrize("path", ["/v1/bodies", "/v1/initial-poses"])
def test_what_is_no_json_is_told(service: Service, path):
    json = {"Content-Type": "application/json; charset=utf-8"}
    malformed = checked(service.client.post(path, content=b"{", headers=json), 400)
    assert (malformed.field, malformed.code) == ("body", "invalid-json")
    checked(service.client.post(path, content=b'{"gender": "male"}'), 415)
    checked(service.client.post(path, content=b" " * 1_000_001, headers=json), 413)


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
