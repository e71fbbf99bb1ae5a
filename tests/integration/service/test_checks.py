"""Checks of pictures over HTTP: asked, refused, told."""

import json
import os
from pathlib import Path

import httpx
import pytest

from api_schemas.checks import CaptureCheck
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import (
    POINTS,
    Machine,
    Service,
    eventually,
    running_service,
)
from tests.integration.service.test_bad_input import checked

WITHOUT_DETECTOR = Path(__file__).parent / "without_detector"


@pytest.fixture(autouse=True, scope="module")
def _ready(service: Service):
    eventually(lambda: asked(service).status_code == 200, what="the estimator answers")


def asked(
    service: Service, script: dict[str, object] | None = None, *, request: object = None
) -> httpx.Response:
    """Ask of a picture that comes along."""
    return service.client.post(
        "/v1/checks",
        files={"image": ("picture.png", scripted_image(script), "image/png")},
        data={} if request is None else {"request": json.dumps(request)},
    )


def test_a_picture_is_checked_with_what_is_said_of_it(service: Service):
    said = {"view": "side", "points": POINTS, "focal_length_px": 900.0}
    answer = asked(service, request=said)
    check = CaptureCheck.model_validate_json(answer.content)
    assert (check.usable, check.findings) == (True, ())
    assert (check.seen_from, check.lean_deg, check.distance_m) == ("side", len(POINTS), 900.0)
    assert answer.headers["cache-control"] == "no-store"


def test_a_bad_picture_is_no_error(service: Service):
    check = CaptureCheck.model_validate_json(asked(service, {"people": 0}).content)
    assert not check.usable
    assert [each.code for each in check.findings] == ["nobody-found"]


def test_points_of_any_layout_are_named_and_may_be_few(service: Service):
    landmarks = [{"x": 0.5, "y": 0.5, "visibility": 0.9}] * 33
    said = {"points": landmarks, "format": "blazepose33"}
    assert asked(service, request=said).json()["lean_deg"] == 21.0
    one = asked(service, request={"points": {"nose": [100, 50]}})
    assert one.json()["lean_deg"] == 1.0


def test_an_uploaded_picture_is_checked_by_its_id(service: Service):
    upload = service.client.post(
        "/v1/images", files={"image": ("p.png", scripted_image({"people": 0}), "image/png")}
    )
    question = {"image_id": upload.json()["id"], "view": "front"}
    answer = service.client.post("/v1/checks", json=question).json()
    assert (answer["usable"], answer["seen_from"]) == (False, "front")
    unknown = service.client.post("/v1/checks", json={"image_id": "0" * 64})
    problem = checked(unknown, 422)
    assert (problem.field, problem.code) == ("image_id", "unknown-image")


@pytest.mark.parametrize(
    ("said", "field", "code"),
    [
        ({"view": "above"}, "view", "unknown-value"),
        ({"person": -1}, "person", "out-of-range"),
        ({"height_m": 170}, "height_m", "out-of-range"),
        ({"points": {"nose": [641, 5]}}, "points.nose", "point-outside-image"),
        ({"points": "auto"}, "points", "wrong-kind"),
        ({"focal_length_px": 9.0, "focal_length_35mm": 9.0}, "focal_length_35mm",
         "two-focal-lengths"),
        ({"mask": True}, "mask", "unknown-field"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_by_field(service: Service, said, field, code):
    problem = checked(asked(service, request=said), 422)
    assert (problem.field, problem.code) == (field, code)


def test_what_is_no_question_is_told(service: Service):
    post = service.client.post
    checked(post("/v1/checks", content=b"GIF89a", headers={"Content-Type": "image/gif"}), 415)
    missing = checked(post("/v1/checks", files={"request": ("r", b"{}")}), 422)
    assert (missing.field, missing.code) == ("image", "missing")
    text = checked(post("/v1/checks", files={"image": ("p.png", b"text")}), 415)
    assert (text.field, text.code) == ("image", "not-an-image")
    large = {"image": ("p.png", scripted_image(width=10_000, height=10_000))}
    assert checked(post("/v1/checks", files=large), 422).code == "image-too-large"


def test_a_detector_that_the_estimator_cannot_load_is_told_unless_there_are_points(
    service: Service,
):
    told = checked(asked(service, {"no_detector": True}), 404)
    assert told.code == "detector-not-installed"
    points = asked(service, {"no_detector": True}, request={"points": POINTS})
    assert points.status_code == 200


def test_without_a_detector_only_points_are_checked(tmp_path: Path, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", str(WITHOUT_DETECTOR), prepend=os.pathsep)
    with running_service(Machine(tmp_path), api_only=True) as service:
        told = checked(asked(service), 404)
        assert told.code == "detector-not-installed"
        eventually(
            lambda: asked(service, request={"points": POINTS}).status_code == 200,
            what="the estimator answers",
        )
