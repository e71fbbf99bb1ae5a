"""Result documents as they are told: what of them, and compressed for whom."""

import hashlib
from typing import Any

import pytest

from tests.integration.service.harness import Service

PLAIN = {"Accept-Encoding": "identity"}
PACKED = {"Accept-Encoding": "br, gzip"}


@pytest.fixture(scope="module")
def job(service: Service) -> dict[str, Any]:
    return service.ended(service.submit())


def test_stages_are_told_to_those_who_ask(service: Service, job: dict[str, Any]):
    path = job["links"]["result"]
    brief, whole = (service.client.get(path, params=asked) for asked in ({}, {"include": "stages"}))
    assert brief.json()["stages"] == []
    assert [each["name"] for each in whole.json()["stages"]] == ["SE"]
    assert brief.json() | {"stages": whole.json()["stages"]} == whole.json()
    assert brief.headers["ETag"] != whole.headers["ETag"]
    tag = {"If-None-Match": brief.headers["ETag"]}
    assert service.client.get(path, headers=tag).status_code == 304
    assert service.client.get(path, params={"include": "stages"}, headers=tag).status_code == 200
    stored = service.client.get(job["links"]["files"]["result.json"])
    assert stored.json() == whole.json()


def test_a_part_that_there_is_not_is_refused_by_name(service: Service, job: dict[str, Any]):
    refused = service.client.get(job["links"]["result"], params={"include": "stagse"})
    assert refused.status_code == 422
    assert refused.json()["field"].startswith("include")
    assert "stages" in refused.json()["detail"] + refused.json()["remedy"]


def test_a_measurement_has_the_interval_that_holds_95_of_100(service: Service, job: dict[str, Any]):
    waist = service.client.get(job["links"]["result"]).json()["measurements"][0]
    value, error = waist["value"], waist["standard_error"]
    assert (waist["low"], waist["high"]) == pytest.approx(
        (value - 1.96 * error, value + 1.96 * error)
    )


def test_json_is_compressed_when_asked_for(service: Service, job: dict[str, Any]):
    for path in (f"{job['links']['result']}?include=stages", "/openapi.json"):
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
