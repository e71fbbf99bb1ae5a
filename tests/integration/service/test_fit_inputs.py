"""A job gives back what it was made of."""

import json
import os
from pathlib import Path

import pytest

from api_schemas.fit import FitRequest
from tests.heif_files import EIGHT_BITS
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import (
    POINTS,
    REQUEST,
    Machine,
    Service,
    running_service,
    said_of_view,
)
from tests.integration.service.test_bad_input import checked
from tests.integration.service.test_formats import wait_for_estimator

WITHOUT_HEIC = Path(__file__).parent / "without_heic"


def test_picture_and_request_of_a_job_can_be_had_again(service: Service):
    job = service.client.get(service.submit()).json()
    picture = service.client.get(job["links"]["files"]["views/0/image"])
    assert picture.content == scripted_image()
    assert picture.headers["content-type"] == "image/png"
    request = service.client.get(job["links"]["request"])
    options = FitRequest.model_validate_json(request.content)
    assert options.height_m == REQUEST["height_m"]
    assert set(json.loads(request.content)["views"][0]["points"]) == set(POINTS)


def test_a_picture_can_be_had_as_a_jpeg(service: Service):
    wait_for_estimator(service)
    link = service.client.get(service.submit()).json()["links"]["files"]["views/0/image"]
    sent = service.client.get(link)
    shown = service.client.get(link, headers={"Accept": "image/jpeg"})
    assert shown.headers["content-type"] == "image/jpeg"
    assert shown.content.startswith(f"JPEG of {len(scripted_image())} bytes".encode())
    assert shown.headers["vary"] == sent.headers["vary"] == "Accept"
    assert shown.headers["etag"] != sent.headers["etag"]
    known = {"Accept": "image/jpeg", "If-None-Match": shown.headers["etag"]}
    assert service.client.get(link, headers=known).status_code == 304
    other = {"Accept": "image/jpeg", "If-None-Match": sent.headers["etag"]}
    assert service.client.get(link, headers=other).status_code == 200


@pytest.mark.parametrize(
    "accept",
    ["image/avif,image/webp,image/*,*/*;q=0.8", "application/json", "image/jpeg;q=0.5, image/png"],
)
def test_who_does_not_prefer_a_jpeg_gets_the_picture_as_it_was_sent(service: Service, accept):
    link = service.client.get(service.submit()).json()["links"]["files"]["views/0/image"]
    answer = service.client.get(link, headers={"Accept": accept})
    assert (answer.headers["content-type"], answer.content) == ("image/png", scripted_image())


def test_a_picture_that_cannot_be_decoded_is_no_jpeg(service: Service):
    wait_for_estimator(service)
    link = service.client.get(service.submit({"damaged": True})).json()["links"]["files"][
        "views/0/image"
    ]
    problem = checked(service.client.get(link, headers={"Accept": "image/jpeg"}), 422)
    assert (problem.field, problem.code) == ("image", "image-damaged")


def test_a_heic_is_kept_as_it_was_sent(service: Service):
    answer = service.client.post("/v1/images", files={"image": ("photo.heic", EIGHT_BITS)})
    kept = answer.raise_for_status().json()
    assert (kept["media_type"], kept["width"], kept["height"]) == ("image/heic", 96, 128)
    inside = {name: [0.2 * x, 0.3 * y] for name, (x, y) in POINTS.items()}
    request = REQUEST | said_of_view(image_id=kept["id"], points=inside)
    job = service.client.post("/v1/fits", json=request).raise_for_status().json()
    sent = service.client.get(job["links"]["files"]["views/0/image"])
    assert (sent.headers["content-type"], sent.content) == ("image/heic", EIGHT_BITS)


def test_where_no_heic_is_decoded_it_is_refused_with_the_remedy(embedded: Machine):
    path = os.pathsep.join((str(WITHOUT_HEIC), os.environ.get("PYTHONPATH", "")))
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", path)
        with running_service(embedded, api_only=True) as service:
            files = {"image": ("photo.heic", EIGHT_BITS)}
            for answer in (
                service.client.post("/v1/images", files=files),
                service.client.post("/v1/points", files=files),
                service.client.post("/v1/fits", files=files, data={"request": json.dumps(REQUEST)}),
            ):
                problem = checked(answer, 415)
                assert problem.field in ("image", "views.0.image")
                assert problem.code == "heic-not-installed"
                assert "maquette[heic]" in problem.remedy


def test_they_are_not_sent_twice_to_who_has_them(service: Service):
    links = service.client.get(service.submit()).json()["links"]
    for link in (links["files"]["views/0/image"], links["request"]):
        tag = service.client.get(link).headers["etag"]
        again = service.client.get(link, headers={"If-None-Match": tag})
        assert (again.status_code, again.content) == (304, b"")


def test_they_are_erased_with_the_fit(service: Service):
    path = service.fitted()
    links = service.job(path)["links"]
    assert service.client.delete(path).status_code == 204
    for link in (links["files"]["views/0/image"], links["request"]):
        assert service.client.get(link).status_code == 404
