"""Result documents as they are told: compressed for whom."""

import hashlib
from typing import Any

import pytest

from tests.integration.service.harness import Service

PLAIN = {"Accept-Encoding": "identity"}
PACKED = {"Accept-Encoding": "br, gzip"}


@pytest.fixture(scope="module")
def job(service: Service) -> dict[str, Any]:
    return service.ended(service.submit())


def test_a_measurement_has_the_interval_that_holds_95_of_100(service: Service, job: dict[str, Any]):
    waist = service.client.get(job["links"]["result"]).json()["measurements"][0]
    value, error = waist["value"], waist["standard_error"]
    assert (waist["low"], waist["high"]) == pytest.approx(
        (value - 1.96 * error, value + 1.96 * error)
    )


def test_json_is_compressed_when_asked_for(service: Service, job: dict[str, Any]):
    for path in (job["links"]["result"], "/openapi.json"):
        plain, packed = (service.client.get(path, headers=each) for each in (PLAIN, PACKED))
        assert "Content-Encoding" not in plain.headers
        assert packed.headers["Content-Encoding"] == "gzip"
        assert int(packed.headers["Content-Length"]) < 0.6 * int(plain.headers["Content-Length"])
        assert packed.json() == plain.json()
        assert "Accept-Encoding" in packed.headers["Vary"]


def test_a_file_has_a_tag_of_its_content(service: Service, job: dict[str, Any]):
    path = job["links"]["files"]["result.json"]
    plain = service.client.get(path, headers=PLAIN)
    tag = f'"{hashlib.sha256(plain.content).hexdigest()}"'
    assert plain.headers["ETag"] == tag
    known = service.client.get(path, headers=PACKED | {"If-None-Match": tag})
    assert known.status_code == 304


def test_events_come_one_by_one_and_meshes_as_they_are(service: Service, job: dict[str, Any]):
    links = job["links"]
    mesh = next(path for name, path in links["files"].items() if name.endswith(".glb"))
    for path in (links["events"], mesh):
        answer = service.client.get(path, headers=PACKED)
        assert answer.status_code == 200
        assert "Content-Encoding" not in answer.headers
