"""A job gives back what it was made of."""

import json
import os
from pathlib import Path

import pytest

from api_schemas.requests import FitOptions
from tests.heif_files import Item, heif, size
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import POINTS, REQUEST, Machine, Service, running_service
from tests.integration.service.scanning import submit_scan
from tests.integration.service.test_bad_input import checked
from tests.integration.service.test_formats import wait_for_estimator

WITHOUT_HEIC = Path(__file__).parent / "without_heic"
HEIC = heif(Item(b"hvc1", b"", (size(640, 480),)))
"""A head without a picture: nothing is decoded here."""


def test_picture_and_request_of_a_job_can_be_had_again(service: Service):
    job = service.client.get(service.submit()).json()
    picture = service.client.get(job["links"]["image"])
    assert picture.content == scripted_image()
    assert picture.headers["content-type"] == "image/png"
    request = service.client.get(job["links"]["request"])
    options = FitOptions.model_validate_json(request.content)
    assert options.height_m == REQUEST["height_m"]
    assert set(json.loads(request.content)["points"]) == set(POINTS)


def test_a_mask_can_be_had_again_where_one_was_sent(service: Service):
    mask = scripted_image({"mask": True})
    files = {
        "image": ("picture.png", scripted_image(), "image/png"),
        "mask": ("mask.png", mask, "image/png"),
    }
    data = {"request": json.dumps(REQUEST)}
    job = service.client.post("/v1/fits", files=files, data=data).json()
    assert service.client.get(job["links"]["mask"]).content == mask
    without = service.client.get(service.submit()).json()
    assert without["links"]["mask"] is None
    answer = service.client.get(f"{without['links']['self']}/mask")
    assert answer.status_code == 404
    assert answer.json()["detail"] == "There is no mask: none was sent with this picture."


def test_a_picture_can_be_had_as_a_jpeg(service: Service):
    wait_for_estimator(service)
    link = service.client.get(service.submit()).json()["links"]["image"]
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
    link = service.client.get(service.submit()).json()["links"]["image"]
    answer = service.client.get(link, headers={"Accept": accept})
    assert (answer.headers["content-type"], answer.content) == ("image/png", scripted_image())


def test_a_picture_that_cannot_be_decoded_is_no_jpeg(service: Service):
    wait_for_estimator(service)
    link = service.client.get(service.submit({"damaged": True})).json()["links"]["image"]
    problem = checked(service.client.get(link, headers={"Accept": "image/jpeg"}), 422)
    assert (problem.field, problem.code) == ("image", "image-damaged")


def test_a_view_of_a_scan_can_be_had_as_a_jpeg(service: Service):
    wait_for_estimator(service)
    link = service.client.get(submit_scan(service)).json()["links"]["self"]
    answer = service.client.get(f"{link}/views/1/image", headers={"Accept": "image/jpeg"})
    assert (answer.status_code, answer.headers["content-type"]) == (200, "image/jpeg")
    assert service.client.get(f"{link}/views/1/image").headers["content-type"] == "image/png"


def test_a_heic_is_kept_as_it_was_sent(service: Service):
    answer = service.client.post("/v1/images", files={"image": ("photo.heic", HEIC)})
    kept = answer.raise_for_status().json()
    assert (kept["media_type"], kept["width"], kept["height"]) == ("image/heic", 640, 480)
    job = service.client.post("/v1/fits", json={**REQUEST, "image_id": kept["id"]}).json()
    sent = service.client.get(job["links"]["image"])
    assert (sent.headers["content-type"], sent.content) == ("image/heic", HEIC)


def test_where_no_heic_is_decoded_it_is_refused_with_the_remedy(embedded: Machine):
    path = os.pathsep.join((str(WITHOUT_HEIC), os.environ.get("PYTHONPATH", "")))
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", path)
        with running_service(embedded, api_only=True) as service:
            files = {"image": ("photo.heic", HEIC)}
            for answer in (
                service.client.post("/v1/images", files=files),
                service.client.post("/v1/checks", files=files),
                service.client.post("/v1/fits", files=files, data={"request": json.dumps(REQUEST)}),
            ):
                problem = checked(answer, 415)
                assert (problem.field, problem.code) == ("image", "heic-not-installed")
                assert "maquette[heic]" in problem.remedy


def test_they_are_not_sent_twice_to_who_has_them(service: Service):
    job = service.client.get(service.submit()).json()
    for link in ("image", "request"):
        tag = service.client.get(job["links"][link]).headers["etag"]
        again = service.client.get(job["links"][link], headers={"If-None-Match": tag})
        assert (again.status_code, again.content) == (304, b"")


def test_they_are_erased_with_the_job(service: Service):
    path = service.submit()
    job = service.client.get(path).json()
    service.ended(path)
    assert service.client.delete(path).status_code == 204
    for link in ("image", "request"):
        assert service.client.get(job["links"][link]).status_code == 404
