"""Tokens and what is uploaded with them: listed, limited, revoked; and when keys were last used."""

import subprocess
import sys
import threading
import time
from uuid import uuid4

import httpx
import pytest

from api_schemas.images import ImagePage
from api_schemas.tokens import IMAGES_OF_JOB, NewToken, Token, TokenPage
from service.engine.keys import ApiKey, Role
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.guarded_service import Guarded, fit, guarded, made
from tests.integration.service.harness import REPOSITORY, Service, eventually
from tests.integration.service.test_bad_input import checked

__all__ = ("guarded",)


def upload(caller: Service) -> httpx.Response:
    """Upload a picture that nobody has."""
    content = scripted_image({"n": uuid4().hex})
    return caller.client.post("/v1/images", files={"image": ("a.png", content)})


def standing(holder: Service, token: NewToken) -> Token:
    answer = holder.client.get(f"/v1/tokens/{token.id}")
    assert answer.status_code == 200, answer.text
    return Token.model_validate_json(answer.content)


def test_a_token_may_have_so_many_pictures_for_each_of_its_jobs(guarded: Guarded):
    holder = guarded.caller(guarded.key(f"shop-{uuid4().hex[:8]}"))
    token = made(holder, jobs=1)
    browser = guarded.caller(token.token)
    paths = [upload(browser).raise_for_status().headers["Location"] for _ in range(IMAGES_OF_JOB)]
    refused = checked(upload(browser), 507)
    assert refused.code == "quota-exceeded"
    assert f"at most {IMAGES_OF_JOB}" in refused.detail
    now = standing(holder, token)
    assert (now.images, now.most_images) == (IMAGES_OF_JOB, IMAGES_OF_JOB)
    # The same picture again is none more, others of the tenant have room, erasing makes some.
    again = browser.client.get(f"{paths[0]}/picture").content
    assert browser.client.post("/v1/images", files={"image": ("a", again)}).status_code == 200
    assert upload(guarded.caller(made(holder, jobs=1).token)).status_code == 201
    assert upload(holder).status_code == 201
    assert browser.client.delete(paths[0]).status_code == 204
    assert upload(browser).status_code == 201


def test_of_many_uploads_at_once_no_more_are_kept_than_a_token_may_have(guarded: Guarded):
    holder = guarded.caller(guarded.key(f"shop-{uuid4().hex[:8]}"))
    token = made(holder, jobs=1)
    browsers = [guarded.caller(token.token) for _ in range(2 * IMAGES_OF_JOB)]
    statuses: list[int] = []
    threads = [
        threading.Thread(target=lambda each=each: statuses.append(upload(each).status_code))
        for each in browsers
    ]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    assert sorted(statuses) == [201] * IMAGES_OF_JOB + [507] * IMAGES_OF_JOB
    assert standing(holder, token).images == IMAGES_OF_JOB


def test_pictures_are_listed_newest_first_over_all_pages(guarded: Guarded):
    holder = guarded.caller(guarded.key(f"shop-{uuid4().hex[:8]}"))
    token = made(holder)
    callers = [holder, guarded.caller(token.token), holder, guarded.caller(token.token), holder]
    ids = [upload(each).json()["id"] for each in callers]
    found: list[tuple[str, str | None]] = []
    path: str | None = "/v1/images?limit=2"
    pages = 0
    while path is not None:
        answer = holder.client.get(path)
        page = ImagePage.model_validate_json(answer.content)
        assert answer.headers.get("Link", "").startswith(f"<{page.next}>") == bool(page.next)
        found += [(each.id, each.token_id) for each in page.images]
        path, pages = page.next, pages + 1
    assert pages == 3
    assert [each for each, _ in found] == ids[::-1]
    assert [each for _, each in found] == [None, token.id, None, token.id, None]
    assert checked(holder.client.get("/v1/images?cursor=x"), 422).code == "unknown-cursor"


def test_tokens_are_listed_with_what_they_have_left_and_to_their_tenant_alone(guarded: Guarded):
    tenant = f"shop-{uuid4().hex[:8]}"
    holder, colleague = (guarded.caller(guarded.key(tenant)) for _ in range(2))
    stranger = guarded.caller(guarded.key(f"{tenant}-not"))
    tokens = [made(holder, jobs=3, label=f"customer-{number}") for number in range(3)]
    browser = guarded.caller(tokens[0].token)
    fit(browser)
    upload(browser).raise_for_status()
    first = TokenPage.model_validate_json(colleague.client.get("/v1/tokens?limit=2").content)
    assert first.next is not None
    second = TokenPage.model_validate_json(colleague.client.get(first.next).content)
    assert second.next is None
    listed = [*first.tokens, *second.tokens]
    assert [each.id for each in listed] == [each.id for each in tokens[::-1]]
    used = listed[-1]
    assert used == standing(holder, tokens[0])
    assert (used.jobs, used.jobs_left, used.images, used.label) == (3, 2, 1, "customer-0")
    assert used.expires_at == tokens[0].expires_at
    assert tokens[0].token not in colleague.client.get("/v1/tokens").text
    assert stranger.client.get("/v1/tokens").json() == {"tokens": [], "next": None}
    path = f"/v1/tokens/{tokens[0].id}"
    for method in ("GET", "DELETE"):
        assert stranger.client.request(method, path).status_code == 404
        assert checked(browser.client.request(method, path), 403).code == "not-for-tokens"
    assert checked(browser.client.get("/v1/tokens"), 403).code == "not-for-tokens"
    assert checked(holder.client.get("/v1/tokens/nonsense"), 422).field == "token_id"


def test_a_revoked_token_is_refused_at_once_and_what_it_made_stays(guarded: Guarded):
    holder = guarded.caller(guarded.key())
    token, other = made(holder), made(holder)
    browser = guarded.caller(token.token)
    job, picture = fit(browser), upload(browser).headers["Location"]
    assert holder.client.delete(f"/v1/tokens/{token.id}").status_code == 204
    assert checked(browser.client.get(job), 401).code == "unauthorized"
    assert checked(upload(browser), 401).code == "unauthorized"
    assert guarded.caller(other.token).client.get("/v1/fits").status_code == 200
    for path in (job, picture):
        assert holder.client.get(path).status_code == 200
    for method in ("GET", "DELETE"):
        assert holder.client.request(method, f"/v1/tokens/{token.id}").status_code == 404
    assert token.id not in holder.client.get("/v1/tokens").text


@pytest.mark.parametrize("path", ["", f"/{'0' * 16}"])
def test_without_keys_no_tokens_are_listed(service: Service, path):
    assert checked(service.client.get(f"/v1/tokens{path}"), 404).code == "authentication-off"


def key_of(guarded: Guarded, secret: str) -> ApiKey:
    return next(each for each in guarded.ring.all_keys() if each.id == secret.split("_")[1])


def test_a_key_says_when_it_was_last_used_itself_or_by_a_token(guarded: Guarded):
    began = time.time()
    secret, unused = guarded.key(), guarded.ring.create("shop", Role.METRICS)
    eventually(lambda: key_of(guarded, secret).used_at, what="its use is known")
    used_at = key_of(guarded, secret).used_at
    assert used_at is not None
    assert began <= used_at <= time.time()
    identity = key_of(guarded, secret).id
    token = made(guarded.caller(secret))
    # An hour ago, in every process: what notes it next may be a token's request.
    guarded.ring.note_use(identity, at=began - 3_600, unless_since=began + 3_600)
    assert key_of(guarded, secret).used_at == began - 3_600
    guarded.ring.note_use(identity, at=began, unless_since=began - 3_601)
    assert key_of(guarded, secret).used_at == began - 3_600, "within the time nothing is written"
    assert guarded.caller(token.token).client.get("/v1/fits").status_code == 200
    printed = subprocess.run(
        [sys.executable, "-m", "service.cli", "keys", "list"],
        env=guarded.service.machine.environment(),
        cwd=REPOSITORY,
        check=True,
        stdout=subprocess.PIPE,
        text=True,
    ).stdout
    lines = {line.split()[0]: line for line in printed.splitlines()}
    day = time.strftime("%Y-%m-%dT%H:%MZ", time.gmtime(began - 3_600))
    assert lines[identity].endswith(f" used {day}")
    assert lines[unused.split("_")[1]].endswith(" no use known")
