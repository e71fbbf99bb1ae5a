"""Tokens of browsers: made with a key, what may be asked with them, and how they end."""

import time
from contextlib import ExitStack
from datetime import UTC, datetime
from uuid import uuid4

import pytest
import sqlalchemy as sa

from service.engine.keys import KeyRing, Role
from service.engine.tables import BROWSER_TOKENS
from tests.integration.service.guarded_service import Guarded, fit, guarded, made, opened
from tests.integration.service.harness import (
    POINTS,
    REQUEST,
    Machine,
    Service,
    eventually,
    running_service,
)
from tests.integration.service.receiver import SECRET
from tests.integration.service.scanning import SCAN, post_scan
from tests.integration.service.test_bad_input import checked

__all__ = ("guarded",)


def test_a_token_makes_fits_and_scans_and_reads_them(guarded: Guarded):
    holder = guarded.caller(guarded.key())
    browser = guarded.caller(made(holder).token)
    path = fit(browser)
    assert browser.ended(path)["state"] == "succeeded"
    job = browser.job(path)
    for link in ("result", "image", "request"):
        assert browser.client.get(job["links"][link]).status_code == 200
    assert browser.client.get(job["links"]["artifacts"]["overlay.png"]).status_code == 200
    assert browser.events(path)[-1]["event"] == "end"
    scan = post_scan(browser)
    assert scan.status_code == 202
    assert browser.ended(scan.headers["Location"])["state"] == "succeeded"
    derived = browser.client.post(f"{path}/derivations", json={"kind": "pose"})
    assert derived.status_code == 202, derived.text
    assert browser.ended(derived.headers["Location"])["state"] == "succeeded"
    again = browser.client.post(f"{path}/retry")
    assert again.status_code == 202
    listed = browser.client.get("/v1/fits").json()["jobs"]
    assert [each["id"] for each in listed] == [again.json()["id"], job["id"]]
    # They are the tenant's.
    assert holder.job(path)["id"] == job["id"]
    assert path in [each["links"]["self"] for each in holder.client.get("/v1/fits").json()["jobs"]]
    browser.ended(again.headers["Location"])
    assert browser.client.delete(path).status_code == 204
    assert holder.client.get(path).status_code == 404


@pytest.mark.parametrize(
    ("method", "path"),
    [
        ("POST", "/v1/tokens"),
        ("GET", "/metrics"),
        ("GET", "/v1/fitsandmore"),
        ("GET", "/v1"),
    ],
)
def test_a_token_may_ask_for_nothing_else(guarded: Guarded, method, path):
    browser = guarded.caller(made(guarded.caller(guarded.key())).token)
    problem = checked(browser.client.request(method, path, json={}), 403)
    assert (problem.code, problem.field) == ("not-for-tokens", "Authorization")


def test_a_token_has_no_notices_sent(guarded: Guarded):
    browser = guarded.caller(made(guarded.caller(guarded.key())).token)
    webhook = {"url": "https://example.org/", "secret": SECRET}
    problem = checked(browser.post(request=REQUEST | {"webhook": webhook}), 403)
    assert (problem.code, problem.field) == ("not-for-tokens", "webhook")


def test_a_token_is_good_for_so_many_jobs(guarded: Guarded):
    holder = guarded.caller(guarded.key())
    browser = guarded.caller(made(holder, jobs=2).token)
    headers = {"Idempotency-Key": uuid4().hex}
    path = browser.post(headers=headers).headers["Location"]
    browser.ended(path)
    assert browser.post(headers=headers).headers["Location"] == path
    assert post_scan(browser).status_code == 202
    for refused in (
        browser.post(),
        post_scan(browser),
        browser.client.post(f"{path}/retry"),
        browser.client.post(f"{path}/derivations", json={"kind": "pose"}),
    ):
        assert checked(refused, 429).code == "token-spent"
    # Erasing makes no room.
    assert browser.client.delete(path).status_code == 204
    assert checked(browser.post(), 429).code == "token-spent"
    assert holder.post().status_code == 202


def test_the_label_of_a_token_goes_before_what_a_browser_says(guarded: Guarded):
    holder = guarded.caller(guarded.key())
    labelled = guarded.caller(made(holder, label="customer-4711").token)
    path = fit(labelled, label="customer-1")
    assert labelled.job(path)["label"] == "customer-4711"
    scan = post_scan(labelled, request={**SCAN, "label": None}).json()
    assert scan["label"] == "customer-4711"
    without = guarded.caller(made(holder).token)
    assert without.job(fit(without, label="own"))["label"] == "own"


def test_an_expired_token_is_refused(guarded: Guarded):
    holder = guarded.caller(guarded.key())
    token = made(holder, lifetime_s=60)
    left_s = (token.expires_at - datetime.now(UTC)).total_seconds()
    assert 50 < left_s <= 60
    browser = guarded.caller(token.token)
    path = fit(browser)
    with guarded.database.begin() as connection:
        connection.execute(
            sa.update(BROWSER_TOKENS)
            .where(BROWSER_TOKENS.c.id == token.id)
            .values(expires_at=time.time())
        )
    eventually(lambda: browser.client.get(path).status_code == 401, what="no more remembered")
    problem = checked(browser.client.get(path), 401)
    assert "POST /v1/tokens" in problem.remedy
    assert checked(browser.post(), 401).code == "unauthorized"
    assert holder.client.get(path).status_code == 200


def test_a_token_ends_with_its_key_and_with_no_other(guarded: Guarded):
    keys = [guarded.key(), guarded.key()]
    browsers = [guarded.caller(made(guarded.caller(key)).token) for key in keys]
    paths = [fit(each) for each in browsers]
    assert guarded.ring.revoke(keys[0].split("_")[1])
    eventually(lambda: browsers[0].client.get(paths[0]).status_code == 401, what="refused")
    assert browsers[0].post().status_code == 401
    assert browsers[1].client.get(paths[1]).status_code == 200


@pytest.mark.parametrize("change", ["last", "id", "cut", "mark", "longer", "key"])
def test_a_tampered_token_is_unknown(guarded: Guarded, change):
    key = guarded.key()
    text = made(guarded.caller(key)).token
    mark, identity, secret = text.split("_", 2)
    tampered = {
        "last": text[:-1] + ("A" if text[-1] != "A" else "B"),
        "id": "_".join((mark, "0" * len(identity), secret)),
        "cut": text[:-1],
        "mark": text.replace("mqt_", "mq_", 1),
        "longer": f"{text}x",
        "key": f"mqt_{key.removeprefix('mq_')}",
    }[change]
    assert guarded.caller(tampered).client.get("/v1/fits").status_code == 401
    assert guarded.caller(text).client.get("/v1/fits").status_code == 200


def test_a_metrics_key_makes_no_tokens(guarded: Guarded):
    watching = guarded.caller(guarded.ring.create("shop", Role.METRICS))
    eventually(lambda: watching.client.get("/metrics").status_code == 200, what="key known")
    assert checked(watching.client.post("/v1/tokens", json={}), 403).code == "wrong-role"


@pytest.mark.parametrize(
    ("asked", "field"),
    [
        ({"lifetime_s": 59}, "lifetime_s"),
        ({"lifetime_s": 3_601}, "lifetime_s"),
        ({"jobs": 0}, "jobs"),
        ({"jobs": 101}, "jobs"),
        ({"label": "a\nb"}, "label"),
        ({"tenant": "other"}, "tenant"),
    ],
)
def test_a_token_that_would_be_good_for_too_much_is_refused(guarded: Guarded, asked, field):
    holder = guarded.caller(guarded.key())
    assert checked(holder.client.post("/v1/tokens", json=asked), 422).field == field


def test_estimates_are_answered_to_a_token(guarded: Guarded):
    browser = guarded.caller(made(guarded.caller(guarded.key())).token)
    eventually(
        lambda: browser.client.post("/v1/bodies", json={"gender": "male"}).status_code == 200,
        what="the estimator answers",
    )
    asked = {"gender": "male", "points": POINTS, "image_size": {"width": 640, "height": 480}}
    assert browser.client.post("/v1/initial-poses", json=asked).status_code != 403
    assert browser.client.get("/v1/body-models").status_code == 200


def test_without_keys_there_are_no_tokens(service: Service):
    problem = checked(service.client.post("/v1/tokens", json={}), 404)
    assert problem.code == "authentication-off"
    assert "MAQUETTE_AUTHENTICATION" in problem.remedy


def test_requests_with_a_token_count_as_those_of_its_key(machine: Machine):
    with opened(machine) as database:
        key = KeyRing(database).create("shop")
    machine.settings = {"authentication": "keys", "requests_per_minute": 10}
    with running_service(machine, api_only=True) as service, ExitStack() as clients:
        guarded = Guarded(service, KeyRing(database), database, clients)
        holder = guarded.caller(key)
        browsers = [guarded.caller(made(holder).token) for _ in range(2)]
        statuses = [each.client.get("/v1/fits").status_code for each in browsers * 8]
        assert statuses[:6] == [200] * 6
        assert 429 in statuses
        assert holder.client.get("/v1/fits").status_code == 429
