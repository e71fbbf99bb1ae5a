"""A stream of events while the database is away: it goes on when that is back."""

import asyncio
import threading
from collections.abc import Sequence
from contextlib import asynccontextmanager
from datetime import UTC, datetime
from types import SimpleNamespace
from typing import Any

import pytest
from fastapi import Response

from api_schemas.jobs import EventData, EventKind, JobState
from service.api import events, fits
from service.api.problems import ProblemError
from service.jobs.records import EngineUnavailableError, JobEvent


class Jobs:
    """Jobs of a tenant whose database is away for some looks."""

    def __init__(self, absences: int) -> None:
        self.absences = absences

    def events(self, _: str, *, after: int) -> Sequence[JobEvent]:
        self.job("")
        return [told(1, EventKind.STATE), told(2, EventKind.END)][after:]

    def job(self, _: str) -> object:
        if self.absences:
            self.absences -= 1
            raise EngineUnavailableError
        return object()


class Feed:
    """Wakes at once."""

    def __init__(self, draining: threading.Event) -> None:
        self._draining = draining

    @property
    def is_ending(self) -> bool:
        return self._draining.is_set()

    async def wait_beyond(self, *_: object, timeout_s: float) -> None:
        assert timeout_s >= 0.0


def told(number: int, kind: EventKind) -> JobEvent:
    data = EventData(at=datetime.now(UTC), state=JobState.SUCCEEDED, stage=None, progress=1.0)
    return JobEvent(number=number, kind=kind, data=data)


def stream(jobs: Jobs, draining: threading.Event) -> list[str]:
    feed: Any = Feed(draining)
    absent: Any = jobs

    async def read() -> list[str]:
        return [part.decode() async for part in events._stream(feed, absent, "a", 0)]

    return asyncio.run(read())


@pytest.fixture(autouse=True)
def _no_pauses(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(events, "AWAY_PAUSE_S", 0.0)


def test_a_stream_goes_on_when_the_database_is_back():
    (_, first, last) = stream(Jobs(absences=5), threading.Event())
    assert ("event: state" in first, "event: end" in last) == (True, True)


def test_a_stream_that_is_silent_meanwhile_says_that_it_is_there(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(events, "PING_S", 0.0)
    parts = stream(Jobs(absences=3), threading.Event())
    assert [part for part in parts if part.startswith(":")]
    assert "event: end" in parts[-1]


def test_a_process_that_stops_ends_its_streams_though_the_database_is_away():
    draining = threading.Event()
    draining.set()
    assert len(stream(Jobs(absences=1_000), draining)) == 1


def test_an_owner_has_a_share_of_streams_and_waits_and_others_have_theirs():
    engine: Any = None
    feed = events.EventFeed(engine, threading.Event(), owners_share=1)
    running: Any = SimpleNamespace(id="a", state=JobState.RUNNING, last_event=0)
    ended: Any = SimpleNamespace(id="a", state=JobState.SUCCEEDED, last_event=-1)

    async def followed(owner: str) -> None:
        context: Any = SimpleNamespace(feed=feed, tenant=owner)
        async with asynccontextmanager(fits._place)(context):
            with feed.place(owner) as is_another:
                assert not is_another

    def waited(owner: str) -> str | None:
        response = Response()
        wait = events.wait_for_end(
            feed, owner, running, lambda: ended, prefer="wait=60", response=response
        )
        asyncio.run(wait)
        return response.headers.get("Preference-Applied")

    with feed.place("mine"):
        with pytest.raises(ProblemError) as caught:
            asyncio.run(followed("mine"))
        assert (caught.value.problem.status, caught.value.problem.code) == (429, "too-many-streams")
        asyncio.run(followed("another's"))
        assert waited("mine") is None
    asyncio.run(followed("mine"))
