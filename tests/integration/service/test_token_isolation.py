"""A token sees only what was made with it: no job and no picture of others."""

from uuid import uuid4

import httpx

from api_schemas.images import ImagePage
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.guarded_service import Guarded, fit, guarded, made
from tests.integration.service.harness import REQUEST, Service
from tests.integration.service.scanning import post_scan
from tests.integration.service.test_bad_input import checked

__all__ = ("guarded",)


def jobs_of(caller: Service) -> list[str]:
    return [each["id"] for each in caller.client.get("/v1/fits").json()["jobs"]]


def test_a_token_sees_no_job_of_others(guarded: Guarded):
    holder = guarded.caller(guarded.key())
    browser, other = (guarded.caller(made(holder).token) for _ in range(2))
    stranger = guarded.caller(made(guarded.caller(guarded.key("elsewhere"))).token)
    own = fit(browser)
    browser.ended(own)
    theirs = [fit(other), fit(holder)]
    scan = post_scan(holder).headers["Location"]
    for path in theirs:
        holder.ended(path)
    derived = holder.client.post(f"{theirs[1]}/derivations", json={"kind": "pose"})
    assert derived.status_code == 202
    paths = [*theirs, scan, derived.headers["Location"]]
    paths += [
        f"{theirs[0]}/{below}"
        for below in (
            "image",
            "request",
            "result",
            "events",
            "derivations",
            "artifacts/overlay.png",
        )
    ]
    paths += [f"{scan}/views/0/image", f"{scan}/request"]
    for path in paths:
        assert holder.client.get(path).status_code in (200, 409), path
        for each in (browser, stranger):
            answer = each.client.get(path)
            # A list below what is not there.
            assert answer.status_code == 404 or answer.json() == {"derivations": [], "next": None}
    for path in (*theirs, scan):
        for each in (browser, stranger):
            assert each.client.delete(path).status_code == 404
            assert each.client.post(f"{path}/cancel").status_code == 404
            assert each.client.post(f"{path}/retry").status_code == 404
    assert jobs_of(browser) == [own.rpartition("/")[2]]
    assert jobs_of(other) == [theirs[0].rpartition("/")[2]]
    assert jobs_of(stranger) == []
    assert browser.client.get("/v1/scans").json()["scans"] == []
    report = {"kind": "pose"}
    assert browser.client.post(f"{theirs[1]}/derivations", json=report).status_code == 404
    assert holder.client.get(theirs[0]).status_code == 200


def test_the_same_idempotency_key_of_another_token_is_another_job(guarded: Guarded):
    holder = guarded.caller(guarded.key())
    headers = {"Idempotency-Key": uuid4().hex}
    callers = [holder, *(guarded.caller(made(holder).token) for _ in range(2))]
    first, second = ([each.post(headers=headers).json()["id"] for each in callers] for _ in "12")
    assert first == second
    assert len(set(first)) == 3


def test_pictures_of_a_token_are_its_own_and_its_tenant_s(guarded: Guarded):
    holder = guarded.caller(guarded.key())
    browser, other = (guarded.caller(made(holder).token) for _ in range(2))
    stranger = guarded.caller(guarded.key("elsewhere"))
    content = scripted_image({"n": uuid4().hex})

    def upload(caller: Service) -> httpx.Response:
        return caller.client.post("/v1/images", files={"image": ("a.png", content)})

    path = upload(browser).headers["Location"]
    body = {**REQUEST, "image_id": path.rpartition("/")[2]}
    for each in (other, stranger):
        assert each.client.get(path).status_code == 404
        assert each.client.delete(path).status_code == 404
        assert checked(each.client.post("/v1/fits", json=body), 422).code == "unknown-image"
        assert path not in listed(each)
    assert holder.client.get(f"{path}/picture").content == content
    assert holder.client.post("/v1/fits", json=body).status_code == 202
    # Nor does an answer tell that somebody else has it.
    assert [upload(each).status_code for each in (other, holder, stranger)] == [201] * 3
    assert (listed(browser), listed(other)) == ([path], [path])
    assert listed(holder).count(path) == 3
    assert browser.client.post("/v1/fits", json=body).status_code == 202
    # A token erases its own, a key all that its tenant has.
    assert other.client.delete(path).status_code == 204
    assert browser.client.get(path).status_code == 200
    assert holder.client.delete(path).status_code == 204
    assert [each.client.get(path).status_code for each in (browser, holder)] == [404, 404]
    assert stranger.client.get(path).status_code == 200


def listed(caller: Service) -> list[str]:
    """The paths of the pictures that somebody sees."""
    answer = caller.client.get("/v1/images", params={"limit": 200})
    images = ImagePage.model_validate_json(answer.content).images
    return [f"/v1/images/{each.id}" for each in images]
