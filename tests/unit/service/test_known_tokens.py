"""Tokens are remembered for seconds, so that most requests cost no query."""

import asyncio
import time
from collections.abc import Sequence
from dataclasses import replace

import pytest

from service.api import credentials
from service.api.browser_tokens import is_allowed
from service.api.credentials import REFRESH_S, KnownTokens
from service.engine.browser_token_port import BrowserToken, NewBrowserToken, TokenStanding

TOKEN = BrowserToken(
    id="1", key_id="k", tenant="shop", jobs=1, label=None, expires_at=time.time() + 3_600
)


class Clock:
    now = 0.0

    def __call__(self) -> float:
        return self.now


class Tokens:
    """Those by their texts, and what was asked for."""

    def __init__(self, **known: BrowserToken) -> None:
        self.known = known
        self.asked: list[str] = []

    def create(self, new: NewBrowserToken) -> tuple[str, BrowserToken]:
        raise AssertionError(new)

    def find(self, presented: str) -> BrowserToken | None:
        self.asked.append(presented)
        return self.known.get(presented)

    def tokens(
        self, tenant: str, *, limit: int, before: tuple[float, str] | None
    ) -> Sequence[TokenStanding]:
        raise AssertionError(tenant, limit, before)

    def token(self, tenant: str, identity: str) -> TokenStanding | None:
        raise AssertionError(tenant, identity)

    def revoke(self, tenant: str, identity: str) -> bool:
        texts = [
            text
            for text, token in self.known.items()
            if (token.tenant, token.id) == (tenant, identity)
        ]
        for text in texts:
            del self.known[text]
        return bool(texts)


def test_a_token_is_looked_up_again_after_seconds_and_then_gone():
    tokens, clock = Tokens(a=TOKEN), Clock()

    async def ask() -> None:
        known = KnownTokens(tokens, monotonic=clock)
        assert await known.find("a") == await known.find("a") == TOKEN
        assert tokens.asked == ["a"]
        tokens.known.clear()
        clock.now = REFRESH_S - 0.1
        assert await known.find("a") == TOKEN
        clock.now = REFRESH_S
        assert await known.find("a") is None
        assert tokens.asked == ["a", "a"]

    asyncio.run(ask())


def test_a_token_that_is_revoked_here_is_refused_at_once_and_no_other():
    tokens = Tokens(a=TOKEN, b=replace(TOKEN, id="2"))

    async def ask() -> None:
        known = KnownTokens(tokens, monotonic=Clock())
        assert await known.find("a") is not None
        assert await known.find("b") is not None
        assert not await known.revoke("elsewhere", "1")
        assert await known.find("a") is not None
        assert await known.revoke("shop", "1")
        assert await known.find("a") is None
        assert await known.find("b") is not None
        assert not await known.revoke("shop", "1")

    asyncio.run(ask())


def test_a_remembered_token_ends_when_its_time_is_over():
    ending = replace(TOKEN, expires_at=time.time() - 0.001)

    async def ask() -> BrowserToken | None:
        return await KnownTokens(Tokens(a=ending), monotonic=Clock()).find("a")

    assert asyncio.run(ask()) is None


def test_no_more_are_remembered_than_there_is_room_for(monkeypatch):
    monkeypatch.setattr(credentials, "MOST_REMEMBERED", 3)
    tokens = Tokens(**{str(number): TOKEN for number in range(9)})

    async def ask() -> int:
        known = KnownTokens(tokens, monotonic=Clock())
        for number in range(9):
            assert await known.find(str(number)) == TOKEN
        return len(known._remembered)

    assert asyncio.run(ask()) <= 3


@pytest.mark.parametrize(
    ("path", "allowed"),
    [
        ("/v1/fits", True),
        ("/v1/fits/1/derivations/2", True),
        ("/v1/scans/1/views/0/image", True),
        ("/v1/images", True),
        ("/v1/checks", True),
        ("/v1/fitsx", False),
        ("/v1/tokens", False),
        ("/v1/anything-new", False),
        ("/metrics", False),
        ("//v1/fits", False),
        ("/V1/fits", False),
    ],
)
def test_only_what_is_listed_may_be_asked_with_a_token(path, allowed):
    assert is_allowed(path) is allowed
