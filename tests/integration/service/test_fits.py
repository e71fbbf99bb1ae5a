"""A fit over HTTP, from the picture to the files, and everything a caller may do to it."""

import hashlib
import json
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from api_schemas.jobs import EventData, Fit
from api_schemas.results import FitResult
from service.jobs.storage_identity import SCOPE as STORAGE_SCOPE
from tests.integration.service.fake_pipeline import STAGES, scripted_image
from tests.integration.service.harness import (
    REQUEST,
    Machine,
    Service,
    eventually,
    is_running,
    pids_noted,
    running_service,
)


def test_a_picture_goes_in_and_a_result_with_its_files_comes_out(either: Service):
    service = either
    response = service.post({"seconds": 0.2})
    assert response.status_code == 202
    path = response.headers["Location"]
    assert int(response.headers["Retry-After"]) > 0
    assert Fit.model_validate_json(response.content).links.self == path

    job = service.ended(path)
    assert job["state"] == "succeeded"
    assert job["progress"] == 1.0
    assert job["attempt"] == 1
    assert job["problem"] is None

    document = service.client.get(job["links"]["result"])
    result = FitResult.model_validate_json(document.content)
    assert result.height_m == REQUEST["height_m"]
    names = {artifact.name for artifact in result.files}
    assert names == {
        "body.png",
        "body_canonical.glb",
        "person.npz",
        "views/0/body_posed.glb",
        "views/0/overlay.png",
        "views/0/segmentation.png",
    }
    for artifact in result.files:
        file = service.client.get(job["links"]["files"][artifact.name])
        assert file.headers["content-type"] == artifact.media_type
        assert len(file.content) == artifact.size
        assert hashlib.sha256(file.content).hexdigest() == artifact.sha256


def test_events_tell_every_stage_in_order_and_end(service: Service):
    events = service.events(service.submit({"seconds": 0.5}))
    assert [int(event["id"]) for event in events] == list(range(1, len(events) + 1))
    assert events[0]["event"] == "state"
    assert events[0]["data"]["state"] == "queued"
    assert [event["event"] for event in events[-2:]] == ["state", "end"]
    assert [event["data"]["state"] for event in events[-2:]] == ["succeeded", "succeeded"]
    reports = [event["data"] for event in events if event["event"] == "progress"]
    assert list(dict.fromkeys(report["stage"] for report in reports)) == list(STAGES)
    shares = [report["progress"] for report in reports]
    assert shares == sorted(shares)
    assert all(report["energies"]["total"] > 0.0 for report in reports)
    for event in events:
        EventData.model_validate_json(json.dumps(event["data"]))


def test_nothing_of_a_fit_is_kept_by_a_browser_so_that_erasing_it_is_enough(service: Service):
    path = service.submit()
    links = service.ended(path)["links"]
    image = links["files"]["views/0/image"]
    paths = [path, links["result"], image, links["request"]]
    for each in (*paths, links["files"]["views/0/overlay.png"], "/v1/fits"):
        assert service.client.get(each).headers["Cache-Control"] == "no-store", each
    assert service.client.delete(path).status_code == 204
    for each in paths:
        assert service.client.get(each).status_code == 404


def test_jobs_are_listed_newest_first_in_pages(service: Service):
    paths = [service.submit() for _ in range(5)]
    failed = service.submit({"unusable": True})
    for path in (*paths, failed):
        service.ended(path)
    pages = list(_pages(service, "/v1/fits?limit=2"))
    assert {len(page) for page in pages[:-1]} == {2}
    listed = [job["links"]["self"] for page in pages for job in page]
    assert listed[:6] == [failed, *paths[::-1]]
    assert len(set(listed)) == len(listed)
    for state in ("failed", "succeeded"):
        jobs = [job for page in _pages(service, f"/v1/fits?state={state}") for job in page]
        assert {job["state"] for job in jobs} == {state}
        named = {job["links"]["self"] for job in jobs}
        assert named & {*paths, failed} == ({failed} if state == "failed" else {*paths})


def _pages(service: Service, following: str | None) -> Iterator[list[dict[str, Any]]]:
    """The jobs of a list, page by page to its end."""
    while following:
        page = service.client.get(following)
        yield page.json()["fits"]
        following = page.json()["next"]
        assert ("Link" in page.headers) == (following is not None)


def test_canceling_a_running_fit_kills_its_process(service: Service, tmp_path: Path):
    note = tmp_path / "pids"
    path = service.submit({"seconds": 3600, "burn": True, "note_pid": str(note)})
    (pid,) = eventually(lambda: pids_noted(note), what="the fit runs")
    response = service.client.post(f"{path}/cancel")
    assert response.status_code == 202
    job = service.ended(path)
    assert job["state"] == "canceled"
    assert not is_running(pid), "who is told that the fit is canceled may count on its processor"
    assert service.client.post(f"{path}/cancel").status_code == 200
    assert service.client.get(f"{path}/result").status_code == 409


def test_canceling_a_waiting_job_ends_it_at_once(without_worker: Service):
    service = without_worker
    path = service.submit()
    response = service.client.post(f"{path}/cancel")
    assert response.status_code == 200
    assert response.json()["state"] == "canceled"
    assert [event["event"] for event in service.events(path)] == ["state", "state", "end"]


def test_erasing_a_running_fit_kills_its_process_and_keeps_no_files(
    service: Service, tmp_path: Path
):
    note = tmp_path / "pids"
    path = service.submit({"seconds": 3600, "burn": True, "note_pid": str(note)})
    (pid,) = eventually(lambda: pids_noted(note), what="the fit runs")
    assert service.client.delete(path).status_code == 204
    eventually(lambda: not is_running(pid), what="the process is gone")
    assert service.ended(service.submit())["state"] == "succeeded"
    blobs = service.machine.data_dir / "blobs"
    eventually(lambda: not list(blobs.rglob(Path(path).name)), what="its files are gone")


def test_the_same_idempotency_key_gives_the_same_job(service: Service):
    key = {"Idempotency-Key": "fits-1"}
    first = service.post({"n": 1}, headers=key)
    again = service.post({"n": 1}, headers=key)
    assert again.headers["Location"] == first.headers["Location"]
    other = service.post({"n": 2}, headers=key)
    assert other.status_code == 422
    assert other.json()["type"] == "/problems/idempotency-key-reused"
    assert service.post({"n": 1}).headers["Location"] != first.headers["Location"]


def test_twenty_requests_with_one_new_key_make_one_job(service: Service):
    locations: list[str] = []

    def post() -> None:
        headers = {"Idempotency-Key": "key-race"}
        locations.append(service.post({}, headers=headers).headers["Location"])

    threads = [threading.Thread(target=post) for _ in range(20)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(locations) == 20
    assert len(set(locations)) == 1


def test_a_caller_may_wait_for_the_end(service: Service):
    done = service.post({"seconds": 0.3}, headers={"Prefer": "wait=60"})
    assert done.status_code == 200
    assert done.json()["state"] == "succeeded"
    assert done.headers["Preference-Applied"] == "wait=60"
    pending = service.post({"seconds": 3600}, headers={"Prefer": "respond-async, wait=1"})
    assert pending.status_code == 202
    assert pending.json()["state"] in ("queued", "running")
    service.client.delete(pending.headers["Location"])


def test_a_full_queue_refuses_new_jobs_and_a_fit_counts_as_its_pictures(tmp_path: Path):
    with running_service(Machine(tmp_path, settings={"max_queued": 3}), api_only=True) as service:
        service.submit_several()
        service.submit_several()
        # Two fits are four pictures, more than three.
        for refused in (service.post_several(), service.post()):
            assert (refused.status_code, refused.json()["code"]) == (503, "queue-full")
            assert refused.json()["type"] == "/problems/queue-full"
            assert int(refused.headers["Retry-After"]) > 0
        scopes = {folder.name for folder in (tmp_path / "blobs").glob("*/*")}
        assert len(scopes - {STORAGE_SCOPE}) == 2


def test_several_pictures_are_fitted_together(either: Service):
    service = either
    images = [scripted_image({"n": 1}), scripted_image({"n": 2}, width=700, height=500)]
    masks = [scripted_image({"m": 1}), scripted_image({"m": 2}, width=700, height=500)]
    answer = service.post_several(images=images, masks=masks)
    assert answer.status_code == 202, answer.text
    ended = service.ended(answer.headers["Location"])
    assert ended["state"] == "succeeded"
    files = ended["links"]["files"]
    for number in range(2):
        assert service.client.get(files[f"views/{number}/image"]).content == images[number]
        assert service.client.get(files[f"views/{number}/mask"]).content == masks[number]
    result = FitResult.model_validate_json(service.client.get(ended["links"]["result"]).content)
    assert [each.view for each in result.views] == ["front", "side"]
    assert result.agreement == 0.5


def test_a_fit_says_which_of_its_pictures_it_is_at(either: Service, tmp_path: Path):
    service, gate = either, tmp_path / "gate"
    path = service.submit_several({}, {"gate": str(gate)})
    at_second = eventually(
        lambda: (fit := service.job(path))["view"] == 1 and fit, what="the second picture"
    )
    assert (at_second["state"], at_second["stage"]) == ("running", "observation")
    gate.touch()
    assert service.ended(path)["view"] is None
    progress = [each["data"] for each in service.events(path) if each["event"] == "progress"]
    assert [each["view"] for each in progress] == [0, 1, None]


FAR = 10**40
"""No database holds such a number."""


def status_after(service: Service, path: str, event: object) -> int:
    """The status of the answer to a reconnection; an endless stream is not waited for."""
    headers = {"Last-Event-ID": str(event)}
    with service.client.stream("GET", f"{path}/events", headers=headers) as answer:
        return answer.status_code


@pytest.fixture(scope="module")
def ended(service: Service) -> str:
    """The path of a fit that has ended."""
    path = service.submit()
    service.ended(path)
    return path


def test_after_the_end_there_is_nothing_to_reconnect_to(service: Service, ended: str):
    last = int(service.events(ended)[-1]["id"])
    for event in (last, last + 1, FAR):
        assert status_after(service, ended, event) == 204, event


def test_who_was_away_at_the_end_is_told_the_rest(service: Service, ended: str):
    events = service.events(ended)
    for seen in (0, 1, len(events) - 1):
        assert service.events(ended, after=seen) == events[seen:]


@pytest.mark.parametrize("event", ["", "later", "-1", "1.5", "1e3", "²"])
def test_what_never_was_an_event_is_refused_by_name(service: Service, ended: str, event: str):
    headers = {b"Last-Event-ID": event.encode()}
    answer = service.client.get(f"{ended}/events", headers=headers)
    assert (answer.status_code, answer.json()["field"]) == (422, "last-event-id")


def test_a_number_beyond_all_events_has_the_rest_of_a_running_job_told(service: Service):
    path = service.submit({"seconds": 60, "burn": True})
    eventually(lambda: service.state(path) == "running", what="the fit runs")
    seen = service.job(path)
    headers = {"Last-Event-ID": str(FAR)}
    with service.client.stream("GET", f"{path}/events", headers=headers) as answer:
        assert answer.status_code == 200
        service.client.post(f"{path}/cancel")
        told = "".join(answer.iter_text())
    assert seen["state"] == "running"
    assert "event: end" in told
    assert '"state":"canceled"' in told
    assert '"state":"queued"' not in told
