"""A job gives back what it was made of."""

import json

from api_schemas.requests import FitOptions
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import POINTS, REQUEST, Service


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
    assert answer.json()["detail"] == "There is no mask: this job was sent none."


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
