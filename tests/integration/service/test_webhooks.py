"""Notices of jobs' ends: signed, sent until they are accepted, to public addresses only."""

import dataclasses
import json
import re
import signal
from pathlib import Path
from typing import Any

import pytest

from api_schemas.jobs import Fit
from api_schemas.webhooks import WebhookEvent
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
from tests.integration.service.receiver import SECRET, Receiver


def with_settings(machine: Machine, **changes: object) -> Machine:
    return dataclasses.replace(machine, settings={**SHARED, **changes})


def submitted(service: Service, script: dict[str, object] | None = None, **webhook: str) -> str:
    answer = service.post(script, request=REQUEST | {"webhook": webhook})
    assert answer.status_code == 202, answer.text
    return answer.headers["Location"]


def settled(service: Service, path: str) -> dict[str, Any]:
    """Wait until the notice was delivered or given up, and return what the job says of it."""

    def webhook() -> dict[str, Any] | None:
        found = service.job(path)["webhook"]
        return found if found["state"] in ("delivered", "given_up") else None

    return eventually(webhook, what=f"the notice of {path} settled")


def given_up(service: Service) -> float:
    """How many notices the figures say were given up."""
    figures = service.client.get("/metrics").text
    found = re.search(r'^maquette_webhooks\{state="given_up"\} (\S+)$', figures, re.MULTILINE)
    return float(found[1]) if found else 0.0


def test_the_end_of_a_fit_is_told_signed_and_repeated_until_it_is_accepted(
    either: Service, receiver: Receiver, tmp_path: Path
):
    service, gate = either, tmp_path / "gate"
    receiver.statuses = [500, 302, 200]
    receiver.headers = {"Location": receiver.url("/elsewhere")}
    webhook = {"url": receiver.url("/a?b=c"), "secret": SECRET}
    answer = service.post({"gate": str(gate)}, request=REQUEST | {"webhook": webhook})
    path = answer.headers["Location"]
    assert service.job(path)["webhook"] == {
        "state": "waiting",
        "attempts": 0,
        "last_status": None,
        "last_error": None,
        "next_attempt_at": None,
    }
    gate.touch()
    assert settled(service, path) == {
        "state": "delivered",
        "attempts": 3,
        "last_status": 200,
        "last_error": None,
        "next_attempt_at": None,
    }
    fit = Fit.model_validate_json(service.client.get(path).content)
    assert [notice.path for notice in receiver.notices] == ["/a?b=c"] * 3
    assert all(notice.is_signed_with(SECRET) for notice in receiver.notices)
    assert not receiver.notices[0].is_signed_with(OWN_SECRET)
    assert {notice.headers["webhook-id"] for notice in receiver.notices} == {str(fit.id)}
    assert len({notice.body for notice in receiver.notices}) == 1
    event = WebhookEvent.model_validate_json(receiver.notices[0].body)
    assert event.type == "fit.succeeded"
    assert event.timestamp == fit.finished_at
    assert event.data == fit.model_copy(update={"webhook": None})
    assert SECRET not in receiver.notices[0].body.decode()


@pytest.mark.parametrize(
    ("script", "kind"),
    [({"unusable": True}, "fit.failed"), ({"segfault": True}, "fit.failed")],
)
def test_failures_are_told_with_their_problem(
    service: Service, receiver: Receiver, script: dict[str, object], kind: str
):
    path = submitted(service, script, url=receiver.url(), secret=SECRET)
    assert settled(service, path)["state"] == "delivered"
    event = receiver.notices[0].event
    assert event["type"] == kind
    assert event["data"]["problem"] == service.job(path)["problem"]


def test_a_canceled_job_is_told_and_an_erased_one_is_not(service: Service, receiver: Receiver):
    erased = submitted(service, {"seconds": 3600}, url=receiver.url("/erased"), secret=SECRET)
    canceled = submitted(service, {"seconds": 3600}, url=receiver.url(), secret=SECRET)
    assert service.client.delete(erased).status_code == 204
    service.client.post(f"{canceled}/cancel")
    assert settled(service, canceled)["state"] == "delivered"
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
    path = service.client.post("/v1/fits", json=body).headers["Location"]
    assert settled(service, path)["state"] == "delivered"
    assert receiver.notices[0].is_signed_with(OWN_SECRET)


def test_the_end_of_a_retried_job_is_told_to_the_same_receiver(
    service: Service, receiver: Receiver
):
    first = submitted(service, {"unusable": True}, url=receiver.url(), secret=SECRET)
    assert settled(service, first)["state"] == "delivered"
    again = service.client.post(f"{first}/retry").headers["Location"]
    assert settled(service, again)["state"] == "delivered"
    assert all(notice.is_signed_with(SECRET) for notice in receiver.notices)
    assert [notice.event["data"]["links"]["self"] for notice in receiver.notices] == [first, again]


def test_after_the_last_attempt_a_notice_is_given_up(service: Service, receiver: Receiver):
    receiver.statuses = [503] * 4
    before = given_up(service)
    path = submitted(service, url=receiver.url(), secret=SECRET)
    webhook = settled(service, path)
    assert (webhook["state"], webhook["attempts"], webhook["last_status"]) == ("given_up", 4, 503)
    assert webhook["last_error"] == "The receiver answered 503."
    assert given_up(service) == before + 1


def test_who_answers_gone_is_not_asked_again(service: Service, receiver: Receiver):
    receiver.statuses = [410]
    webhook = settled(service, submitted(service, url=receiver.url(), secret=SECRET))
    assert (webhook["state"], webhook["attempts"]) == ("given_up", 1)


def test_a_receiver_that_does_not_answer_is_left_at_the_time_limit(
    embedded: Machine, receiver: Receiver
):
    receiver.gate.clear()
    settings = with_settings(embedded, webhook_time_limit_s=0.3, webhook_pauses_s="0")
    with running_service(settings) as service:
        webhook = settled(service, submitted(service, url=receiver.url(), secret=SECRET))
    assert webhook["last_error"] == "No answer within 0.3 s."
    assert (webhook["state"], webhook["attempts"]) == ("given_up", 2)


def test_a_notice_outlives_kill_9_of_the_api(machine: Machine, receiver: Receiver):
    receiver.statuses = [503]
    settings = with_settings(machine, webhook_pauses_s="3600")
    with running_service(settings) as service:
        path = submitted(service, url=receiver.url(), secret=SECRET)
        eventually(lambda: service.job(path)["webhook"]["last_status"] == 503)
        service.process.send_signal(signal.SIGKILL)
        service.process.wait()
    assert len(receiver.notices) == 1
    settings.rewrite(path, webhook_due_at=1.0)
    with running_service(settings) as service:
        assert settled(service, path)["attempts"] == 2
    assert len(receiver.notices) == 2
    assert receiver.notices[0].body == receiver.notices[1].body


def test_a_stopping_api_hands_an_attempt_back(embedded: Machine, receiver: Receiver):
    receiver.gate.clear()
    with running_service(with_settings(embedded, webhook_time_limit_s=PATIENCE_S)) as service:
        path = submitted(service, url=receiver.url(), secret=SECRET)
        eventually(lambda: receiver.notices)
        service.process.send_signal(signal.SIGTERM)
        service.process.wait()
    receiver.gate.set()
    with running_service(with_settings(embedded)) as service:
        webhook = settled(service, path)
    assert (webhook["state"], webhook["attempts"]) == ("delivered", 1)


@pytest.mark.parametrize(
    "url",
    [
        "http://127.0.0.1:9/",
        "http://localhost/",
        "http://[::1]/",
        "http://[::ffff:10.0.0.1]/",
        "http://169.254.169.254/latest/meta-data",
        "http://192.168.1.1/",
    ],
)
def test_an_address_that_is_not_public_is_refused_at_once(without_worker: Service, url: str):
    answer = without_worker.post(request=REQUEST | {"webhook": {"url": url, "secret": SECRET}})
    problem = answer.json()
    assert (answer.status_code, problem["code"]) == (422, "address-not-public")
    assert problem["field"] == "webhook.url"


@pytest.mark.parametrize("url", ["https://example.org:8443/", "http://example.org:22/"])
def test_another_port_than_the_usual_is_refused_at_once(service: Service, url: str):
    answer = service.post(request=REQUEST | {"webhook": {"url": url, "secret": SECRET}})
    problem = answer.json()
    assert (answer.status_code, problem["code"]) == (422, "port-not-allowed")
    assert problem["field"] == "webhook.url"
    assert "443 or 80" in problem["remedy"]


def test_a_name_that_stands_for_this_machine_is_refused_when_it_is_looked_up(
    embedded: Machine, receiver: Receiver
):
    settings = with_settings(
        embedded,
        webhook_hosts="",
        webhook_ports=str(receiver.port),
        webhook_pauses_s="0",
        webhook_time_limit_s=0.5,
    )
    with running_service(settings) as service:
        path = submitted(service, url=receiver.url(host="127.1"), secret=SECRET)
        webhook = settled(service, path)
    assert webhook["state"] == "given_up"
    assert webhook["last_error"] == "The receiver's name stands for no public address."
    assert receiver.notices == []


def test_a_notice_nobody_could_sign_is_refused(without_worker: Service):
    answer = without_worker.post(request=REQUEST | {"webhook": {"url": "https://example.org/"}})
    assert (answer.status_code, answer.json()["field"]) == (422, "webhook.secret")


def test_no_secret_is_ever_answered(service: Service, receiver: Receiver):
    path = submitted(service, url=receiver.url("/token-in-path"), secret=SECRET)
    settled(service, path)
    answers = [
        service.client.get(each).text
        for each in (path, "/v1/fits", f"{path}/result", f"{path}/request")
    ]
    assert all(SECRET not in answer for answer in answers), json.dumps(answers)
