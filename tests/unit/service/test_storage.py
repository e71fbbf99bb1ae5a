"""What is asked of a storage that is away, or does not answer."""

import asyncio
import threading
from pathlib import Path

import pytest
from starlette.concurrency import run_in_threadpool

from service.api import storage
from service.api.problems import ProblemError
from service.api.storage import erase_blobs
from service.jobs.blobs import (
    AWAY_S,
    SILENT_AFTER_S,
    BlobsUnavailableError,
    WatchedBlobs,
)
from service.jobs.blobs_local import LocalBlobStore

PATIENCE_S = 600.0


class Storage(LocalBlobStore):
    def __init__(self, *, is_away: bool) -> None:
        super().__init__(Path("/nowhere"))
        self.is_away = is_away
        self.erased: list[str] = []

    def erase(self, scope: str) -> None:
        if self.is_away:
            raise BlobsUnavailableError
        self.erased.append(scope)


def test_every_scope_is_erased():
    storage = Storage(is_away=False)
    asyncio.run(erase_blobs(WatchedBlobs(storage), ["a", "b"]))
    assert storage.erased == ["a", "b"]


def test_a_storage_that_is_away_is_said_to_be_and_what_becomes_of_the_files():
    with pytest.raises(ProblemError) as refused:
        asyncio.run(erase_blobs(WatchedBlobs(Storage(is_away=True)), ["a"]))
    told = refused.value.problem
    assert (told.status, told.code) == (503, "storage-unavailable")
    assert "erased once that is back" in told.detail


class Clock:
    now = 5.0

    def __call__(self) -> float:
        return self.now


class Silent(LocalBlobStore):
    """Answers once it is let."""

    def __init__(self, clock: Clock | None = None) -> None:
        super().__init__(Path("/nowhere"))
        self.clock = clock
        self.open = threading.Event()
        self.asked = threading.Event()

    def get(self, scope: str, name: str) -> bytes:
        self.asked.set()
        assert self.open.wait(PATIENCE_S)
        return b"picture"

    def check_writable(self) -> None:
        if not self.open.is_set():
            assert self.clock is not None
            self.clock.now += SILENT_AFTER_S + 0.1
            raise BlobsUnavailableError


def test_a_storage_that_is_silent_is_not_asked_again_until_it_answers():
    silent, clock = Silent(), Clock()
    watched = WatchedBlobs(silent, monotonic=clock)
    waiting = threading.Thread(target=watched.get, args=("scope", "name"))
    waiting.start()
    assert silent.asked.wait(PATIENCE_S)
    watched.check_answering()
    clock.now += SILENT_AFTER_S + 0.1
    with pytest.raises(BlobsUnavailableError):
        watched.get("scope", "name")
    silent.open.set()
    waiting.join(PATIENCE_S)
    assert watched.get("scope", "name") == b"picture"


def test_a_storage_that_a_look_found_silent_is_not_asked_until_another_finds_it_or_time_passes():
    clock = Clock()
    silent = Silent(clock)
    watched = WatchedBlobs(silent, monotonic=clock)
    for _ in range(2):
        with pytest.raises(BlobsUnavailableError):
            watched.check_writable()
        with pytest.raises(BlobsUnavailableError):
            watched.get("scope", "name")
        clock.now += AWAY_S
        watched.check_answering()
    with pytest.raises(BlobsUnavailableError):
        watched.check_writable()
    assert not silent.asked.is_set()
    silent.open.set()
    watched.check_writable()
    assert watched.get("scope", "name") == b"picture"


def test_who_waits_for_a_storage_keeps_no_thread_of_others(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(storage, "TURN_WITHIN_S", 0.1)
    silent = Silent()
    watched = WatchedBlobs(silent)

    async def ask() -> None:
        asked = [
            asyncio.create_task(storage.with_blobs(watched, watched.get, "scope", "name"))
            for _ in range(60)
        ]
        refused, _ = await asyncio.wait(asked, timeout=1.0)
        assert 40 <= len(refused) < 60
        assert all(isinstance(each.exception(), BlobsUnavailableError) for each in refused)
        assert await run_in_threadpool(lambda: "listed") == "listed"
        assert await storage.writing(lambda: "canceled") == "canceled"
        silent.open.set()
        await asyncio.wait(asked)

    asyncio.run(ask())
