"""Notices of jobs' ends: signed, sent until they are accepted, to public addresses only."""

import asyncio
import dataclasses
import json
import signal
import threading
from collections import Counter
from pathlib import Path

import pytest

from api_schemas.jobs import Fit, WebhookEvent
from service.jobs.database import open_database, prepare_database
from service.jobs.executions import client_of
from service.jobs.notices import AT_ONCE, enqueue_notice, start_notices, stop_notices
from service.jobs.records import JobRecord
from service.jobs.rows import find_job
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import (
    OWN_SECRET,
    PATIENCE_S,
    REQUEST,
    SHARED,
    Machine,
    Service,
    eventually,
    running_service,
    said_of_view,
)
from tests.integration.service.receiver import SECRET, Notice, Receiver
from tests.stored_jobs import insert_job


def submitted(service: Service, script: dict[str, object] | None = None, **webhook: str) -> str:
    answer = service.post(script, request=REQUEST | {"webhook": webhook})
    assert answer.status_code == 202, answer.text
    return answer.headers["Location"]


def told(receiver: Receiver, times: int = 1) -> list[Notice]:
    """The notices, once so many have come."""
    eventually(lambda: len(receiver.notices) >= times, what="notices")
    return receiver.notices


def test_the_end_of_a_fit_is_told_signed_and_repeated_until_it_is_accepted(
    either: Service, receiver: Receiver
):
    service = either
    receiver.statuses = [500, 302, 200]
    receiver.headers = {"Location": receiver.url("/elsewhere")}
    webhook = {"url": receiver.url("/a?b=c"), "secret": SECRET}
    path = submitted(service, **webhook)
    notices = told(receiver, 3)
    job = Fit.model_validate_json(service.client.get(path).content)
    assert [notice.path for notice in notices] == ["/a?b=c"] * 3
    assert all(notice.is_signed_with(SECRET) for notice in notices)
    assert not notices[0].is_signed_with(OWN_SECRET)
    assert {notice.headers["webhook-id"] for notice in notices} == {str(job.id)}
    assert len({notice.body for notice in notices}) == 1
    event = WebhookEvent.model_validate_json(notices[0].body)
    assert event.type == "fit.succeeded"
    assert event.timestamp == job.finished_at
    assert event.data == job
    assert SECRET not in notices[0].body.decode()


def test_a_canceled_job_is_told_and_an_erased_one_is_not(service: Service, receiver: Receiver):
    erased = submitted(service, {"seconds": 3600}, url=receiver.url("/erased"), secret=SECRET)
    canceled = submitted(service, {"seconds": 3600}, url=receiver.url(), secret=SECRET)
    assert service.client.delete(erased).status_code == 204
    service.client.post(f"{canceled}/cancel")
    told(receiver)
    assert [(each.path, each.event["type"]) for each in receiver.notices] == [
        ("/hook", "fit.canceled")
    ]


def test_a_fit_of_an_uploaded_picture_is_told_too_with_the_services_own_secret(
    service: Service, receiver: Receiver
):
    picture = service.client.post(
        "/v1/images", files={"image": ("p.png", scripted_image(), "image/png")}
    ).json()
    body = REQUEST | said_of_view(image_id=picture["id"]) | {"webhook": {"url": receiver.url()}}
    assert service.client.post("/v1/fits", json=body).status_code == 202
    assert told(receiver)[0].is_signed_with(OWN_SECRET)


def test_who_answers_gone_is_not_asked_again(service: Service, receiver: Receiver):
    receiver.statuses = [410]
    submitted(service, url=receiver.url("/gone"), secret=SECRET)
    told(receiver)
    receiver.statuses = [500]
    submitted(service, url=receiver.url(), secret=SECRET)
    assert [each.path for each in told(receiver, 3)] == ["/gone", "/hook", "/hook"]


def test_a_notice_outlives_kill_9_of_the_api(embedded: Machine, receiver: Receiver):
    receiver.gate.clear()
    shared = dataclasses.replace(embedded, settings=SHARED)
    with running_service(shared) as service:
        submitted(service, url=receiver.url(), secret=SECRET)
        told(receiver)
        service.process.send_signal(signal.SIGKILL)
        service.process.wait()
    receiver.gate.set()
    with running_service(shared):
        first, second = told(receiver, 2)
    assert first.body == second.body


def test_a_receiver_that_does_not_answer_delays_nobody_elses_notice(tmp_path: Path):
    url = f"sqlite:///{tmp_path / 'maquette.sqlite'}"
    prepare_database(url)
    database = open_database(url)
    client = client_of(database)
    under_way = Counter[str]()
    is_told = threading.Event()

    async def send(job: JobRecord) -> None:
        under_way[job.tenant] += 1
        if job.tenant == "other":
            is_told.set()
        else:
            await asyncio.Event().wait()

    def end(name: str, tenant: str) -> None:
        with database.begin() as connection:
            insert_job(connection, name, tenant=tenant, webhook_target="0" * 64)
            job = find_job(connection, name)
            assert job is not None
            enqueue_notice(client, connection, job)

    start_notices(database, send)
    try:
        for number in range(3 * AT_ONCE):
            end(f"dead-{number}", "dead")
        eventually(lambda: under_way["dead"] == AT_ONCE, what="notices of one owner")
        end("other", "other")
        assert is_told.wait(PATIENCE_S)
        assert under_way["dead"] == AT_ONCE
    finally:
        stop_notices()
        database.dispose()


@pytest.mark.parametrize("url", ["http://127.0.0.1:9/", "http://localhost/"])
def test_an_address_that_is_not_public_is_refused_at_once(without_worker: Service, url: str):
    answer = without_worker.post(request=REQUEST | {"webhook": {"url": url, "secret": SECRET}})
    problem = answer.json()
    assert (answer.status_code, problem["code"]) == (422, "address-not-public")
    assert problem["field"] == "webhook.url"


def test_a_notice_nobody_could_sign_is_refused(without_worker: Service):
    answer = without_worker.post(request=REQUEST | {"webhook": {"url": "https://example.org/"}})
    assert (answer.status_code, answer.json()["field"]) == (422, "webhook.secret")


def test_no_secret_is_ever_answered(service: Service, receiver: Receiver):
    path = submitted(service, url=receiver.url("/token-in-path"), secret=SECRET)
    told(receiver)
    answers = [
        service.client.get(each).text
        for each in (path, "/v1/fits", f"{path}/result", f"{path}/request")
    ]
    assert all(SECRET not in answer for answer in answers), json.dumps(answers)
