"""What is derived from a fit: a job below it, with a fit's guarantees, that ends with the fit."""

import hashlib
import time
from pathlib import Path
from typing import Any
from uuid import uuid4

import httpx
import pytest

from api_schemas.derivations import Derivation, DerivationEvent, DerivationPage, DerivationResult
from service.engine.storage_identity import SCOPE as STORAGE_SCOPE
from tests.integration.service.harness import (
    Machine,
    Service,
    eventually,
    is_running,
    pids_noted,
    running_service,
)
from tests.integration.service.receiver import SECRET, Receiver

POSE = {"kind": "pose"}


def fitted(service: Service, derivation: dict[str, object] | None = None) -> str:
    """Have a fit made whose derivations do as the script says, and return its path."""
    path = service.submit({"derivation": derivation or {}})
    assert service.ended(path)["state"] == "succeeded"
    return path


def post(service: Service, fit: str, body: object = POSE, **headers: str) -> httpx.Response:
    return service.client.post(f"{fit}/derivations", json=body, headers=headers)


def derived(service: Service, fit: str, body: object = POSE) -> str:
    """Have something derived from a fit, and return the path of the job."""
    answer = post(service, fit, body)
    assert answer.status_code == 202, answer.text
    return answer.headers["Location"]


def problem(answer: httpx.Response) -> tuple[int, str, str | None]:
    body = answer.json()
    return answer.status_code, body["code"], body["field"]


def test_a_pose_is_asked_for_and_its_files_come_out(either: Service):
    service = either
    fit = fitted(service)
    assert service.job(fit)["links"]["derivations"] == f"{fit}/derivations"
    answer = post(service, fit)
    assert answer.status_code == 202
    assert int(answer.headers["Retry-After"]) > 0
    accepted = Derivation.model_validate_json(answer.content)
    path = answer.headers["Location"]
    assert accepted.links.self == path == f"{fit}/derivations/{accepted.id}"
    assert accepted.links.fit == fit

    job = service.ended(path)
    assert (job["state"], job["progress"], job["attempt"]) == ("succeeded", 1.0, 1)
    assert job["expires_at"] == service.job(fit)["expires_at"]
    document = service.client.get(job["links"]["result"])
    result = DerivationResult.model_validate_json(document.content).root
    assert {each.name for each in result.artifacts} == {
        "body_reposed.glb",
        "pose.png",
        "texture.jpg",
    }
    for artifact in result.artifacts:
        file = service.client.get(job["links"]["artifacts"][artifact.name])
        assert file.headers["content-type"].partition(";")[0] == artifact.media_type
        assert hashlib.sha256(file.content).hexdigest() == artifact.sha256
    part = service.client.get(job["links"]["artifacts"]["pose.png"], headers={"Range": "bytes=0-2"})
    assert (part.status_code, part.content) == (206, b"PNG")
    assert service.client.get(job["links"]["request"]).json()["kind"] == "pose"


def test_derivations_are_listed_below_their_fit_and_not_among_fits(service: Service):
    one, other = fitted(service), fitted(service)
    paths = [derived(service, one) for _ in range(3)]
    for path in paths:
        service.ended(path)
    first = service.client.get(f"{one}/derivations?limit=2")
    page = DerivationPage.model_validate_json(first.content)
    assert page.next is not None
    assert page.next in first.headers["Link"]
    rest = DerivationPage.model_validate_json(service.client.get(page.next).content)
    listed = [each.links.self for each in (*page.derivations, *rest.derivations)]
    assert (listed, rest.next) == (paths[::-1], None)
    failed = service.client.get(f"{one}/derivations?state=failed").json()
    assert failed["derivations"] == []
    assert service.client.get(f"{other}/derivations").json()["derivations"] == []
    fits = service.client.get("/v1/fits").json()["jobs"]
    assert [each["links"]["self"] for each in fits[:2]] == [other, one]
    assert not any("/derivations/" in each["links"]["self"] for each in fits)


def test_a_derivation_is_found_below_its_own_fit_alone(service: Service):
    one, other = fitted(service), fitted(service)
    path = derived(service, one)
    service.ended(path)
    number = path.rpartition("/")[2]
    for wrong in (f"{other}/derivations/{number}", f"/v1/fits/{number}"):
        for what in ("", "/events", "/result", "/artifacts/pose.png", "/request"):
            assert service.client.get(f"{wrong}{what}").status_code == 404, what
        assert service.client.post(f"{wrong}/cancel").status_code == 404
        assert service.client.delete(wrong).status_code == 404
    assert service.client.get(f"{path}/artifacts/nothing.pdf").status_code == 404
    assert service.state(path) == "succeeded"


def test_nothing_is_derived_from_a_fit_that_has_not_succeeded(service: Service):
    waiting = service.submit({"seconds": 3600})
    assert problem(post(service, waiting))[:2] == (409, "no-result")
    service.client.delete(waiting)
    failed = service.submit({"unusable": True})
    service.ended(failed)
    assert problem(post(service, failed))[:2] == (409, "image-truncated")
    assert service.job(failed)["links"]["derivations"] is None
    nobodys = f"/v1/fits/{uuid4()}"
    assert post(service, nobodys).status_code == 404
    assert service.client.get(f"{nobodys}/derivations").status_code == 404


@pytest.mark.parametrize(
    ("body", "status", "code", "field"),
    [
        ({}, 422, "unknown-value", "kind"),
        ({"kind": "bust"}, 422, "unknown-value", "kind"),
        ([], 422, "unknown-value", "kind"),
        ({"kind": "pose", "pages": 2}, 422, "unknown-field", "pages"),
        ({"kind": "caricature", "factor": -1}, 422, "out-of-range", "factor"),
        ({"kind": "caricature", "factor": 1e9}, 422, "out-of-range", "factor"),
        ({"kind": "caricature", "factor": "2"}, 422, "wrong-kind", "factor"),
        ({"kind": "animation", "start_s": -0.1}, 422, "out-of-range", "start_s"),
        ({"kind": "animation", "duration_s": 0}, 422, "out-of-range", "duration_s"),
        ({"kind": "texture", "size": 1000}, 422, "unknown-value", "size"),
        ({"kind": "texture", "size": True}, 422, "wrong-kind", "size"),
        ({"kind": "texture", "colours": "sepia"}, 422, "unknown-value", "colours"),
        ({"kind": "pose", "pose": "handstand"}, 422, "unknown-value", "pose"),
        (
            {"kind": "pose", "rotations": {"left_hand": [0.1, 0.2]}},
            422,
            "wrong-length",
            "rotations.left_hand",
        ),
        (
            {"kind": "pose", "rotations": {"left_hand": [0, 0, 90]}},
            422,
            "out-of-range",
            "rotations.left_hand.2",
        ),
        (
            {"kind": "pose", "webhook": {"url": "http://192.168.1.1/hook"}},
            422,
            "address-not-public",
            "webhook.url",
        ),
    ],
)
def test_a_request_at_fault_is_refused_with_the_field(
    service: Service, body: object, status: int, code: str, field: str
):
    assert problem(post(service, fitted(service), body)) == (status, code, field)


MOTIONS = Path(__file__).parents[2] / "unit" / "applications" / "data" / "bvh"
BVH = (MOTIONS / "r_identity.bvh").read_text(encoding="ascii")
"""Five seconds of a walk."""


def post_motion(service: Service, fit: str, clip: str = BVH, **changes: Any) -> httpx.Response:
    form: dict[str, Any] = {
        "files": {"bvh": ("clip.bvh", clip, "text/plain")},
        "data": {"request": '{"kind": "animation", "start_s": 1}'},
    }
    return service.client.post(f"{fit}/derivations", **form | changes)


def test_a_motion_comes_along_with_the_request(service: Service):
    fit = fitted(service)
    job = service.ended(post_motion(service, fit).headers["Location"])
    assert job["state"] == "succeeded"
    links = job["links"]
    assert service.client.get(links["result"]).json()["source"] == BVH[:40]
    asked = service.client.get(links["request"]).json()
    assert asked == {
        "kind": "animation",
        "motion": "walk",
        "start_s": 1.0,
        "duration_s": None,
        "colours": "picture",
        "joints": {},
        "up": None,
    }
    walking = service.ended(derived(service, fit, {"kind": "animation"}))
    assert service.client.get(walking["links"]["result"]).json()["source"] == "a walk"


def test_a_texture_is_made_of_the_fit_s_own_picture(service: Service):
    asked = {"kind": "texture", "colours": "albedo", "size": 512.0}
    job = service.ended(derived(service, fitted(service), asked))
    assert job["state"] == "succeeded"
    result = service.client.get(job["links"]["result"]).json()
    assert (result["colours"], result["size"]) == ("albedo", 512)


@pytest.mark.parametrize("number", ["NaN", "Infinity", "1e999"])
def test_numbers_that_are_none_are_refused(service: Service, number: str):
    answer = service.client.post(
        f"{fitted(service)}/derivations",
        content=f'{{"kind": "caricature", "factor": {number}}}',
        headers={"Content-Type": "application/json"},
    )
    assert answer.status_code in (400, 422)


def test_what_is_no_json_is_refused(service: Service):
    path = f"{fitted(service)}/derivations"
    broken = service.client.post(
        path, content=b'{"kind"', headers={"Content-Type": "application/json"}
    )
    assert problem(broken)[:2] == (400, "invalid-json")
    assert service.client.post(path, content=b"kind=pose").status_code == 415


def test_the_same_idempotency_key_gives_the_same_derivation(service: Service):
    one, other = fitted(service), fitted(service)
    first, again = (post(service, one, **{"Idempotency-Key": "pose-1"}) for _ in range(2))
    assert first.headers["Location"] == again.headers["Location"]
    elsewhere = post(service, other, **{"Idempotency-Key": "pose-1"})
    assert problem(elsewhere)[:2] == (422, "idempotency-key-reused")


def test_a_derivation_may_be_waited_for_and_followed(service: Service):
    fit = fitted(service)
    done = post(service, fit, Prefer="wait=60")
    assert (done.status_code, done.json()["state"]) == (200, "succeeded")
    events = service.events(done.headers["Location"])
    assert [event["data"]["state"] for event in events][:: len(events) - 1] == [
        "queued",
        "succeeded",
    ]
    assert {event["data"]["stage"] for event in events} == {None, "pose"}
    tag = service.client.get(done.headers["Location"]).headers["ETag"]
    seen = service.client.get(done.headers["Location"], headers={"If-None-Match": tag})
    assert seen.status_code == 304


def test_canceling_a_derivation_kills_its_process_and_leaves_the_fit(
    service: Service, tmp_path: Path
):
    note = tmp_path / "pids"
    fit = fitted(service, {"seconds": 3600, "burn": True, "note_pid": str(note)})
    path = derived(service, fit)
    (pid,) = eventually(lambda: pids_noted(note), what="the derivation runs")
    assert service.client.post(f"{path}/cancel").status_code == 202
    assert service.ended(path)["state"] == "canceled"
    assert not is_running(pid)
    assert service.client.post(f"{path}/cancel").status_code == 200
    assert problem(service.client.get(f"{path}/result"))[:2] == (409, "no-result")
    assert service.state(fit) == "succeeded"


@pytest.mark.parametrize(
    ("script", "code"),
    [
        ({"fault": True}, "fit-failed"),
        ({"exhaust_memory": True}, "out-of-memory"),
        ({"segfault": True}, "fit-crashed"),
    ],
)
def test_a_derivation_that_fails_says_why(service: Service, script: dict, code: str):
    path = derived(service, fitted(service, script))
    job = service.ended(path)
    assert (job["state"], job["problem"]["code"]) == ("failed", code)


def test_erasing_a_fit_stops_what_is_derived_from_it_and_keeps_nothing(
    either: Service, tmp_path: Path
):
    service = either
    note = tmp_path / "pids"
    fit = fitted(service, {"seconds": 3600, "burn": True, "note_pid": str(note)})
    paths = [derived(service, fit) for _ in range(2)]
    pids = eventually(lambda: pids_noted(note), what="a derivation runs")
    assert service.client.delete(fit).status_code == 204
    for path in paths:
        assert service.client.get(path).status_code == 404
    eventually(lambda: not any(map(is_running, pids)), what="the processes are gone")
    names = {Path(path).name for path in (fit, *paths)}
    blobs = service.machine.data_dir / "blobs"
    eventually(
        lambda: not names & {each.name for each in blobs.rglob("*")}, what="the blobs are gone"
    )


def test_a_derivation_is_erased_alone_and_its_fit_stays(service: Service):
    fit = fitted(service)
    path = derived(service, fit)
    service.ended(path)
    assert service.client.delete(path).status_code == 204
    assert service.client.get(path).status_code == 404
    assert service.client.get(f"{fit}/result").status_code == 200


def test_a_derivation_expires_with_its_fit(tmp_path: Path):
    machine = Machine(tmp_path, settings={"sweep_interval_s": 0.3})
    with running_service(machine) as service:
        fit = fitted(service)
        path = derived(service, fit)
        assert service.ended(path)["expires_at"] == service.job(fit)["expires_at"]
        for each in (fit, path):
            machine.rewrite(each, expires_at=time.time())
        for gone in (fit, path, f"{path}/events", f"{fit}/derivations"):
            eventually(lambda gone=gone: service.client.get(gone).status_code == 410, what=gone)
        blobs = tmp_path / "blobs"
        eventually(lambda: {each.name for each in blobs.glob("*/*")} == {STORAGE_SCOPE})


def test_waiting_derivations_count_among_the_jobs_of_the_queue(tmp_path: Path):
    machine = Machine(tmp_path, settings={"max_queued": 2, "worker_processes": 1})
    with running_service(machine) as service:
        fit = fitted(service, {"seconds": 3600})
        paths = [derived(service, fit)]
        eventually(lambda: service.state(paths[0]) == "running", what="the first runs")
        paths += [derived(service, fit) for _ in range(2)]
        assert problem(post(service, fit))[:2] == (503, "queue-full")
        assert problem(service.post())[:2] == (503, "queue-full")
        # Else the service, told to stop, would wait for what runs.
        assert service.client.delete(fit).status_code == 204


def test_the_end_of_a_derivation_is_told(either: Service, receiver: Receiver):
    service = either
    webhook = {"url": receiver.url(), "secret": SECRET}
    path = derived(service, fitted(service), POSE | {"webhook": webhook})
    eventually(lambda: service.job(path)["webhook"]["state"] == "delivered", what="told")
    (notice,) = receiver.notices
    assert notice.is_signed_with(SECRET)
    event = DerivationEvent.model_validate_json(notice.body)
    job = Derivation.model_validate_json(service.client.get(path).content)
    assert (event.type, event.timestamp) == ("derivation.succeeded", job.finished_at)
    assert event.data == job.model_copy(update={"webhook": None})
    stored = service.client.get(f"{path}/request").text
    assert SECRET not in stored
