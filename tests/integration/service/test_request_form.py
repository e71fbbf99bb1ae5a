"""What holds of every request and answer: parameters, bodies, HEAD, compression, tags."""

from typing import Any
from urllib.parse import urlsplit

import pytest

from tests.contract.document import exported
from tests.integration.service.harness import Service
from tests.integration.service.limited_server import Caller
from tests.integration.service.test_bad_input import checked


def port_of(service: Service) -> int:
    port = urlsplit(str(service.client.base_url)).port
    assert port is not None
    return port


def test_a_misspelt_filter_is_refused_by_its_name(service: Service):
    asked = service.client.get("/v1/fits", params={"limit": 1, "sate": "failed"})
    problem = checked(asked, 422)
    assert (problem.field, problem.code) == ("sate", "unknown-field")
    assert all(name in problem.remedy for name in ("limit", "cursor", "state", "label"))


@pytest.mark.parametrize(
    ("method", "path"),
    [
        ("GET", "/v1/body-models"),
        ("GET", f"/v1/images/{'0' * 64}"),
        ("POST", "/v1/points"),
    ],
)
def test_where_there_are_no_parameters_none_is_taken(service: Service, method, path):
    answer = service.client.request(method, path, params={"access_token": "secret-1"})
    problem = checked(answer, 422)
    assert (problem.field, problem.code) == ("access_token", "unknown-field")
    assert "none" in problem.remedy
    assert "secret-1" not in answer.text


def test_a_parameter_that_comes_twice_is_refused(service: Service):
    problem = checked(service.client.get("/v1/fits?state=failed&state=queued"), 422)
    assert (problem.field, problem.code) == ("state", "repeated-field")


def test_however_many_unknown_parameters_there_are_the_answer_is_short(service: Service):
    answer = service.client.get("/v1/fits?" + "&".join(f"p{n}" for n in range(2_000)))
    problem = checked(answer, 422)
    assert len(problem.errors) == 10
    assert "1990 more are at fault." in problem.detail


@pytest.mark.parametrize("path", ["/", "/page/sample.jpg", "/healthz/live", "/openapi.json"])
def test_what_a_browser_or_a_probe_adds_elsewhere_does_not_matter(service: Service, path):
    assert service.client.get(path, params={"embedded": "1"}).status_code == 200


def test_a_body_of_two_ends_is_refused_and_nothing_after_it_is_answered(service: Service):
    smuggled = "GET /healthz/live HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"
    with Caller(port_of(service)) as caller:
        caller.ask(
            "/v1/bodies",
            method="POST",
            headers="Content-Type: application/json\r\nContent-Length: 4\r\n"
            "Transfer-Encoding: chunked\r\n",
        )
        caller.send(f"0\r\n\r\n{smuggled}")
        # The connection ends with it.
        told = caller.problem(400)
    assert (told.field, told.code) == ("Content-Length", "ambiguous-length")


def test_head_is_answered_as_get_without_the_body(service: Service):
    fit = service.fitted()
    paths = ["/", "/docs", "/page/sample.jpg", "/healthz/live", "/metrics", "/openapi.json"]
    paths += ["/v1/fits", "/v1/body-models", "/v1/bodies", "/v1/fits/nothing", "/nothing", fit]
    paths += [f"{fit}/{each}" for each in ("result", "events", "files/body_canonical.glb")]
    for path in paths:
        whole, head = service.client.get(path), service.client.head(path)
        assert (head.status_code, head.content) == (whole.status_code, b""), path
        for name in ("content-type", "etag", "content-length", "allow", "retry-after"):
            # Figures change by the request.
            if (path, name) != ("/metrics", "content-length"):
                assert head.headers.get(name) == whole.headers.get(name), (path, name)


PLAIN = {"Accept-Encoding": "identity"}
PACKED = {"Accept-Encoding": "br, gzip"}


@pytest.fixture(scope="module")
def job(service: Service) -> dict[str, Any]:
    return service.ended(service.submit())


def test_json_is_compressed_when_asked_for(service: Service, job: dict[str, Any]):
    for path in (
        job["links"]["result"],
        job["links"]["files"]["result.json"],
        "/openapi.json",
    ):
        plain, packed = (service.client.get(path, headers=each) for each in (PLAIN, PACKED))
        assert "Content-Encoding" not in plain.headers
        assert packed.headers["Content-Encoding"] == "gzip"
        assert int(packed.headers["Content-Length"]) < 0.6 * int(plain.headers["Content-Length"])
        assert packed.json() == plain.json()
        assert "Accept-Encoding" in packed.headers["Vary"]


def test_events_come_one_by_one_and_meshes_as_they_are(service: Service, job: dict[str, Any]):
    links = job["links"]
    mesh = next(path for name, path in links["files"].items() if name.endswith(".glb"))
    for path in (links["events"], mesh):
        answer = service.client.get(path, headers=PACKED)
        assert answer.status_code == 200
        assert "Content-Encoding" not in answer.headers


def test_the_served_document_is_the_exported_one_and_has_a_page(service: Service):
    assert service.client.get("/openapi.json").json() == exported()
    assert service.client.get("/docs").status_code == 200
