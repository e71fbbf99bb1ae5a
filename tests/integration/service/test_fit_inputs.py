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
