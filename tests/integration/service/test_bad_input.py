"""Every error is problem+json that names the field, the reason and what to do."""

import json

import httpx
import pytest

from api_schemas.problems import PROBLEM_MEDIA_TYPE, PROBLEM_TYPES, Problem
from tests.fuzz.requests import RawRequest
from tests.fuzz.sending import send
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import (
    REQUEST,
    Machine,
    Service,
    running_service,
    said_of_view,
)

UNKNOWN = "/v1/fits/00000000-0000-0000-0000-000000000000"


def kept(service: Service) -> list[str]:
    """The ids of the newest fits there are."""
    return [job["id"] for job in service.client.get("/v1/fits").raise_for_status().json()["fits"]]


@pytest.fixture(scope="module")
def kept_before(service: Service) -> list[str]:
    """The ids of the newest fits there were before this module's tests."""
    return kept(service)


@pytest.fixture(autouse=True)
def _looked_before(kept_before: list[str]) -> None:
    pass


def checked(response: httpx.Response, status: int) -> Problem:
    """Check what holds for every problem, and return it."""
    assert response.status_code == status, response.text
    assert response.headers["content-type"] == PROBLEM_MEDIA_TYPE
    problem = Problem.model_validate_json(response.content)
    assert problem.status == status
    assert problem.instance == response.request.url.path
    assert problem.detail
    assert problem.remedy
    slug = problem.type.removeprefix("/problems/")
    assert PROBLEM_TYPES[slug].status == status
    return problem


def post(service: Service, *, image: bytes | None = None, **parts: bytes) -> httpx.Response:
    files = {
        "image": ("p.png", scripted_image() if image is None else image, "image/png"),
        "request": ("r.json", json.dumps(REQUEST).encode(), "application/json"),
    } | {name: (name, content, "application/octet-stream") for name, content in parts.items()}
    return service.client.post("/v1/fits", files=files)


@pytest.mark.parametrize(
    ("changes", "field", "code"),
    [
        ({"height_m": 1.1}, "height_m", "out-of-range"),
        (said_of_view(image_id="0" * 64), "views.0.image_id", "one-picture-needed"),
    ],
)
def test_a_bad_option_is_refused_at_once(service: Service, changes, field, code):
    problem = checked(post(service, request=json.dumps(REQUEST | changes).encode()), 422)
    assert problem.field == field
    assert problem.code == code
    assert problem.errors[0].field == field


def test_each_fault_of_several_pictures_names_the_picture(service: Service):
    images = [scripted_image(), b"text"]
    problem = checked(service.post_several(images=images), 415)
    assert (problem.field, problem.code) == ("views.1.image", "not-an-image")
    masks = [scripted_image(), scripted_image(width=10)]
    problem = checked(service.post_several(masks=masks), 422)
    assert (problem.field, problem.code) == ("views.1.mask", "mask-size-mismatch")


def test_masks_are_none_or_as_many_as_pictures(service: Service):
    problem = checked(service.post_several(masks=[scripted_image()]), 422)
    assert (problem.field, problem.code) == ("mask", "views-count")


def test_missing_unknown_and_doubled_parts_are_named(service: Service):
    picture = ("p.png", scripted_image(), "image/png")
    response = service.client.post("/v1/fits", files=[("image", picture), ("photo", picture)])
    problem = checked(response, 422)
    assert {(error.field, error.code) for error in problem.errors} == {
        ("request", "missing"),
        ("photo", "unknown-field"),
    }
    request = ("r.json", json.dumps(REQUEST), "application/json")
    twice = [("image", picture), ("request", request), ("request", request)]
    assert checked(service.client.post("/v1/fits", files=twice), 422).code == "repeated-field"


@pytest.mark.parametrize(
    ("content", "content_type"),
    [
        (b"nonsense", "multipart/form-data; boundary=x"),
        (b"--x\r\nContent-Disposition: form-data\r\n\r\n1\r\n--x--", "multipart/form-data"),
        (b"--x\r\n\r\n\r\n\r\n--x--", "multipart/form-data; boundary=x"),
    ],
)
def test_a_broken_multipart_body_is_malformed(service: Service, content, content_type):
    headers = {"Content-Type": content_type}
    checked(service.client.post("/v1/fits", content=content, headers=headers), 400)


@pytest.mark.parametrize(
    ("charset", "name", "content"),
    [
        ("utf-7", "request", "+2AA-"),
        ("utf-7", "+2AA-", "{}"),
        ("unicode_escape", "request", r"\ud800"),
        ("undefined", "request", "{}"),
    ],
)
def test_a_form_that_is_no_text_in_its_charset_is_malformed(
    service: Service, charset, name, content
):
    form = f'--x\r\nContent-Disposition: form-data; name="{name}"\r\n\r\n{content}\r\n--x--\r\n'
    headers = {"Content-Type": f"multipart/form-data; boundary=x; charset={charset}"}
    checked(service.client.post("/v1/fits", content=form.encode(), headers=headers), 400)


def test_a_body_cut_off_before_its_parts_end_lacks_them(service: Service):
    headers = {"Content-Type": "multipart/form-data; boundary=x"}
    content = b'--x\r\nContent-Disposition: form-data; name="image"\r\n\r\ncut'
    problem = checked(service.client.post("/v1/fits", content=content, headers=headers), 422)
    assert {error.code for error in problem.errors} == {"missing"}


@pytest.mark.parametrize("content_type", [None, "application/xml", "text/plain"])
def test_another_kind_of_body_is_refused(service: Service, content_type):
    headers = {} if content_type is None else {"Content-Type": content_type}
    checked(service.client.post("/v1/fits", content=b"{}", headers=headers), 415)


def test_nothing_bad_was_kept(service: Service, kept_before: list[str]):
    assert kept(service) == kept_before


@pytest.mark.parametrize(
    ("method", "path", "status"),
    [
        ("GET", "/nothing", 404),
        ("GET", f"{UNKNOWN}/events", 404),
        ("GET", f"{UNKNOWN}/files/views/0/overlay.png", 404),
        ("POST", f"{UNKNOWN}/cancel", 404),
        ("DELETE", UNKNOWN, 404),
        ("GET", "/problems/unheard-of", 404),
        ("GET", "/v1/fits/not-a-uuid", 422),
        ("GET", "/v1/fits?limit=many", 422),
        ("GET", "/v1/fits?state=asleep", 422),
        ("GET", "/v1/fits?cursor=nonsense", 422),
        ("PUT", "/v1/fits", 405),
        ("DELETE", "/openapi.json", 405),
    ],
)
def test_every_other_error_is_a_problem_too(service: Service, method, path, status):
    checked(service.client.request(method, path), status)


@pytest.mark.parametrize(
    ("path", "allowed"), [("/v1/fits", "GET, HEAD, POST"), (UNKNOWN, "DELETE, GET, HEAD")]
)
def test_a_wrong_method_is_told_all_the_right_ones(service: Service, path, allowed):
    assert service.client.put(path).headers["Allow"] == allowed


@pytest.mark.parametrize(
    ("name", "value"), [("Origin", "http://[::1"), ("Origin", "null"), ("Host", "[::1")]
)
def test_an_address_that_is_none_comes_from_elsewhere(service: Service, name, value):
    problem = checked(service.client.post("/v1/bodies", json={}, headers={name: value}), 403)
    assert problem.field == name


def test_an_upload_above_the_limit_is_refused_declared_or_not(tmp_path):
    machine = Machine(tmp_path, settings={"max_upload_bytes": 1000})
    with running_service(machine, api_only=True) as service:
        assert checked(post(service, image=bytes(3_000_000)), 413).type.endswith("too-large")
        upload = {"image": ("p.png", bytes(3_000_000), "image/png")}
        checked(service.client.post("/v1/images", files=upload), 413)
        head = b'--x\r\nContent-Disposition: form-data; name="image"; filename="p"\r\n\r\n'
        chunks = (part for part in [head, *[bytes(100_000)] * 30])
        headers = {"Content-Type": "multipart/form-data; boundary=x"}
        response = service.client.post("/v1/fits", content=chunks, headers=headers)
        checked(response, 413)


def test_who_is_still_sending_what_is_refused_already_reads_why(service: Service):
    # Sends all before it reads, as httpx does not.
    body = (
        b'--limit\r\nContent-Disposition: form-data; name="request"\r\n\r\n'
        + bytes(50_000_000)
        + b"\r\n--limit--\r\n"
    )
    head = (
        "POST /v1/fits HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n"
        "Content-Type: multipart/form-data; boundary=limit\r\n"
        f"Content-Length: {len(body)}\r\n\r\n"
    ).encode()
    assert service.client.base_url.port is not None
    answer = send(service.client.base_url.port, RawRequest(content=head + body))
    assert (answer.status, answer.fault) == (400, None)


def test_every_problem_type_is_described_where_it_points(service: Service):
    for slug, kind in PROBLEM_TYPES.items():
        answer = service.client.get(f"/problems/{slug}").json()
        assert answer["title"] == kind.title
        assert answer["description"]
