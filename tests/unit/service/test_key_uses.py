"""Uses of keys are written now and then, and no request waits for it."""

import asyncio
import threading

from service.api.auth import BETWEEN_NOTES_S, KeyUses
from service.jobs.records import EngineUnavailableError

PATIENCE_S = 600.0


class Store:
    """Notes what is written, once it is let."""

    def __init__(self) -> None:
        self.written: list[str] = []
        self.open = threading.Event()
        self.open.set()
        self.away = False

    def note_use(self, identity: str, *, at: float, unless_since: float) -> None:
        assert self.open.wait(PATIENCE_S)
        assert at - unless_since == BETWEEN_NOTES_S
        self.written.append(identity)
        if self.away:
            raise EngineUnavailableError


class Clock:
    now = 5.0

    def __call__(self) -> float:
        return self.now


async def written(uses: KeyUses) -> None:
    while uses._writing:
        await asyncio.wait(uses._writing)


def test_a_key_in_use_is_written_at_once_and_then_once_a_minute():
    store, clock = Store(), Clock()

    async def ask() -> None:
        uses = KeyUses(store, monotonic=clock)
        for _ in range(100):
            uses.note("a")
        uses.note("b")
        await written(uses)
        assert store.written == ["a", "b"]
        clock.now += BETWEEN_NOTES_S - 0.1
        uses.note("a")
        await written(uses)
        assert store.written == ["a", "b"]
        clock.now += 0.1
        uses.note("a")
        await written(uses)
        assert store.written == ["a", "b", "a"]

    asyncio.run(ask())


def test_a_request_does_not_wait_for_a_database_that_is_slow():
    store = Store()
    store.open.clear()

    async def ask() -> None:
        uses = KeyUses(store, monotonic=Clock())
        uses.note("a")
        await asyncio.sleep(0)
        assert store.written == []
        store.open.set()
        await written(uses)
        assert store.written == ["a"]

    asyncio.run(ask())


def test_a_database_that_is_away_is_asked_again_when_the_next_use_is_due():
    store, clock = Store(), Clock()
    store.away = True

    async def ask() -> None:
        uses = KeyUses(store, monotonic=clock)
        for _ in range(2):
            uses.note("a")
            uses.note("a")
            await written(uses)
            clock.now += BETWEEN_NOTES_S
        assert store.written == ["a", "a"]

    asyncio.run(ask())
