"""A texture of the caller's own comes along as a part of a form, as a motion does."""

import json
from typing import Any

import httpx
import pytest

from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import Service
from tests.integration.service.test_derivations import BVH, fitted, post, problem


def post_texture(service: Service, fit: str, content: bytes, **changes: Any) -> httpx.Response:
    form: dict[str, Any] = {
        "files": {"texture": ("skin.png", content, "image/png")},
        "data": {"request": '{"kind": "texture", "colours": "own"}'},
    }
    return service.client.post(f"{fit}/derivations", **form | changes)


def test_a_texture_of_one_s_own_comes_along_with_the_request(service: Service):
    painted = scripted_image(width=256, height=256)
    job = service.ended(post_texture(service, fitted(service), painted).headers["Location"])
    assert job["state"] == "succeeded"
    result = service.client.get(job["links"]["result"]).json()
    assert (result["colours"], result["size"]) == ("own", len(painted))


@pytest.mark.parametrize(
    ("content", "status", "code"),
    [
        (b"", 422, "empty-upload"),
        (b"skin", 415, "not-an-image"),
        (b"\x89PNG\r\n\x1a\n", 422, "image-damaged"),
        (scripted_image(width=256, height=255), 422, "texture-size"),
        (scripted_image(width=63, height=63), 422, "texture-size"),
        (scripted_image(width=2049, height=2049), 422, "texture-size"),
        (scripted_image(width=9000, height=9000), 422, "image-too-large"),
    ],
)
def test_a_texture_at_fault_is_refused_with_the_part(
    service: Service, content: bytes, status: int, code: str
):
    assert problem(post_texture(service, fitted(service), content)) == (status, code, "texture")


def test_a_file_comes_along_where_it_is_wanted_and_nowhere_else(service: Service):
    fit, painted = fitted(service), scripted_image(width=256, height=256)
    own = {"kind": "texture", "colours": "own"}
    assert problem(post(service, fit, own)) == (422, "missing", "texture")
    alone = {"data": {"request": json.dumps(own)}, "files": {"bvh": ("m.bvh", BVH)}}
    missing = service.client.post(f"{fit}/derivations", **alone)
    assert problem(missing) == (422, "missing", "texture")
    for other in ({"kind": "texture"}, {"kind": "pose"}, {"kind": "animation"}):
        data = {"request": json.dumps(other)}
        answer = post_texture(service, fit, painted, data=data)
        assert problem(answer) == (422, "unknown-field", "texture")
    both = {"texture": ("skin.png", painted), "bvh": ("m.bvh", BVH)}
    assert problem(post_texture(service, fit, painted, files=both)) == (422, "unknown-field", "bvh")


def test_a_form_may_hold_the_request_alone(service: Service):
    form = {"files": {"request": ("request.json", '{"kind": "pose"}', "application/json")}}
    answer = service.client.post(f"{fitted(service)}/derivations", **form)
    assert (answer.status_code, answer.json()["kind"]) == (202, "pose")
