"""How one process spends what it takes from a shared bucket, and what it does without one."""

import asyncio
import logging
import threading
from collections.abc import Callable, Coroutine
from dataclasses import dataclass, field
from typing import Any

import pytest

from service.api.rate_limit import RETRY_AWAY_S, UNSPENT_S, RateLimit
from service.engine.port import EngineUnavailableError
from service.engine.token_port import Grant

KEY = "0123abcd"
PATIENCE_S = 600.0


@dataclass
class Clock:
    now: float = 1_000.0

    def __call__(self) -> float:
        return self.now


@dataclass
class Shared:
    """A shared bucket that others fill and empty as they like."""

    tokens: int
    wait_s: float = 1.5
    error: Exception | None = None
    answers: threading.Event = field(default_factory=threading.Event)
    exchanges: list[tuple[str, int, int]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.answers.set()

    def exchange(self, key: str, *, returned: int, wanted: int) -> Grant:
        self.exchanges.append((key, returned, wanted))
        assert self.answers.wait(PATIENCE_S)
        if self.error is not None:
            raise self.error
        granted = min(wanted, self.tokens)
        self.tokens += returned - granted
        return Grant(tokens=granted, wait_s=0.0 if self.tokens else self.wait_s)


def run(
    scenario: Callable[[RateLimit, Clock], Coroutine[Any, Any, None]],
    shared: Shared,
    *,
    per_minute: int = 40,
    patience_s: float = PATIENCE_S,
) -> None:
    clock = Clock()

    async def main() -> None:
        limit = RateLimit(shared, per_minute=per_minute, patience_s=patience_s, monotonic=clock)
        await scenario(limit, clock)

    asyncio.run(main())


async def passed(limit: RateLimit, requests: int, *, key: str = KEY) -> int:
    """Ask one after the other; returns how many were let pass."""
    return [await limit.take(key) for _ in range(requests)].count(0)


@pytest.mark.parametrize(
    ("per_minute", "requests", "exchanges"), [(1_200, 600, 10), (40, 40, 20), (10, 10, 10)]
)
def test_a_twentieth_of_the_capacity_is_taken_at_a_time(
    per_minute: int, requests: int, exchanges: int
):
    shared = Shared(tokens=per_minute)

    async def scenario(limit: RateLimit, _: Clock) -> None:
        assert await passed(limit, requests) == requests

    run(scenario, shared, per_minute=per_minute)
    assert len(shared.exchanges) == exchanges
    assert {wanted for *_, wanted in shared.exchanges} == {max(1, per_minute // 20)}


def test_what_others_took_is_not_there():
    shared = Shared(tokens=7)

    async def scenario(limit: RateLimit, _: Clock) -> None:
        assert await passed(limit, 40) == 7

    run(scenario, shared)


def test_who_was_refused_is_not_asked_for_before_the_time_that_was_told():
    shared = Shared(tokens=0, wait_s=1.5)

    async def scenario(limit: RateLimit, clock: Clock) -> None:
        assert await limit.take(KEY) == 2
        shared.tokens = 5
        clock.now += 1.0
        assert await limit.take(KEY) == 1
        assert len(shared.exchanges) == 1
        clock.now += 1.0
        assert await limit.take(KEY) == 0
        assert len(shared.exchanges) == 2

    run(scenario, shared)


def test_keys_are_limited_each_for_itself():
    shared = Shared(tokens=0)

    async def scenario(limit: RateLimit, _: Clock) -> None:
        assert await limit.take(KEY) == 2
        shared.tokens = 2
        assert await limit.take("other") == 0
        assert await limit.take(KEY) == 2

    run(scenario, shared)


def test_many_who_ask_at_once_share_one_exchange():
    shared = Shared(tokens=30)

    async def scenario(limit: RateLimit, _: Clock) -> None:
        answers = await asyncio.gather(*(limit.take(KEY) for _ in range(38)))
        assert answers.count(0) == 30
        assert set(answers) == {0, 2}

    run(scenario, shared)
    assert shared.exchanges == [(KEY, 0, 38)]


def test_one_process_alone_passes_no_more_than_the_limit_whatever_it_is_given():
    shared = Shared(tokens=1_000_000)

    async def scenario(limit: RateLimit, clock: Clock) -> None:
        assert await passed(limit, 80) == 40
        assert await limit.take(KEY) == 2
        clock.now += 3.0
        assert await passed(limit, 80) == 2

    run(scenario, shared)


@pytest.mark.parametrize("error", [EngineUnavailableError(), ValueError("no error of ours")])
def test_without_a_database_a_process_limits_by_itself(
    error: Exception, caplog: pytest.LogCaptureFixture
):
    shared = Shared(tokens=0, error=error)

    async def scenario(limit: RateLimit, clock: Clock) -> None:
        assert await passed(limit, 80) == 40
        assert len(shared.exchanges) == 1
        clock.now += 30.0
        assert await passed(limit, 80) == 20

    with caplog.at_level(logging.WARNING):
        run(scenario, shared)
    warnings = [record for record in caplog.records if record.levelno == logging.WARNING]
    assert len(warnings) == 1, "an outage is told once"


def test_a_database_that_is_back_is_asked_again():
    shared = Shared(tokens=0, error=EngineUnavailableError())

    async def scenario(limit: RateLimit, clock: Clock) -> None:
        assert await limit.take(KEY) == 0
        shared.error = None
        clock.now += RETRY_AWAY_S / 2
        assert await limit.take(KEY) == 0
        clock.now += RETRY_AWAY_S / 2
        assert await limit.take(KEY) == 2

    run(scenario, shared)


def test_a_database_that_is_slow_holds_up_nobody_for_long_and_is_paid_later():
    shared = Shared(tokens=20)
    shared.answers.clear()

    async def scenario(limit: RateLimit, _: Clock) -> None:
        try:
            assert await asyncio.gather(*(limit.take(KEY) for _ in range(8))) == [0] * 8
            assert await passed(limit, 3) == 3
        finally:
            shared.answers.set()
        exchange = limit._accounts[KEY].exchange
        assert exchange is not None
        await exchange
        assert len(shared.exchanges) == 1
        assert await passed(limit, 40) == 9

    run(scenario, shared, patience_s=0.01)


def test_what_passed_without_a_database_is_taken_from_the_bucket_when_it_is_back():
    shared = Shared(tokens=30, error=EngineUnavailableError())

    async def scenario(limit: RateLimit, clock: Clock) -> None:
        assert await passed(limit, 12) == 12
        shared.error = None
        clock.now += 3.0
        # Two have come in: ten are paid for, of thirty.
        assert await limit.take(KEY) == 0
        assert shared.exchanges[-1] == (KEY, 0, 12)
        assert shared.tokens == 18

    run(scenario, shared)


def test_what_is_not_spent_is_given_back():
    shared = Shared(tokens=1_200)

    async def scenario(limit: RateLimit, clock: Clock) -> None:
        assert await passed(limit, 10) == 10
        clock.now += UNSPENT_S / 2
        await limit.give_back()
        assert shared.tokens == 1_140
        clock.now += UNSPENT_S / 2
        await limit.give_back()
        assert shared.tokens == 1_190
        assert shared.exchanges[-1] == (KEY, 50, 0)
        assert await limit.take(KEY) == 0

    run(scenario, shared, per_minute=1_200)


def test_at_the_end_everything_is_given_back():
    shared = Shared(tokens=1_200)

    async def scenario(limit: RateLimit, _: Clock) -> None:
        async with limit.giving_back():
            assert await passed(limit, 10) == 10
            assert await passed(limit, 5, key="other") == 5
        assert shared.tokens == 1_185

    run(scenario, shared, per_minute=1_200)


def test_a_process_that_ends_without_a_database_ends():
    shared = Shared(tokens=1_200)

    async def scenario(limit: RateLimit, _: Clock) -> None:
        async with limit.giving_back():
            assert await limit.take(KEY) == 0
            shared.error = EngineUnavailableError()

    run(scenario, shared, per_minute=1_200)
    assert len(shared.exchanges) == 2


def test_keys_that_are_not_used_any_more_are_forgotten():
    shared = Shared(tokens=40)

    async def scenario(limit: RateLimit, clock: Clock) -> None:
        await limit.take(KEY)
        for _ in range(2):
            clock.now += 60.0
            await limit.give_back()
        assert limit._accounts == {}

    run(scenario, shared)
