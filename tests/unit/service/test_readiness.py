"""Probes share looks at database and storage, and are answered while one goes on."""

import asyncio
import threading
from collections.abc import Coroutine
from dataclasses import dataclass, field
from typing import Any

import pytest

from api_schemas.service import Health
from service.api.health import Look, Readiness, not_ready
from service.api.problems import ProblemError
from service.jobs.records import EngineUnavailableError

PATIENCE_S = 600.0
"""A guard against hanging."""


@dataclass
class Parts:
    """Database and storage, which answer once they are let go."""

    silent: bool = False
    fault: Exception | None = None
    looks: int = 0
    at: str = "database"
    reached: threading.Event = field(default_factory=threading.Event)
    let_go: threading.Event = field(default_factory=threading.Event)

    def check(self, look: Look) -> Health:
        self.looks += 1
        look.at = self.at
        self.reached.set()
        if self.silent:
            assert self.let_go.wait(PATIENCE_S)
        if self.fault is not None:
            raise self.fault
        return Health(status="ready", workers=self.looks, queued=0)


@dataclass
class Clock:
    now: float = 100.0

    def __call__(self) -> float:
        return self.now


def readiness(parts: Parts, clock: Clock, *, answer_within_s: float = PATIENCE_S) -> Readiness:
    return Readiness(parts.check, answer_within_s=answer_within_s, monotonic=clock)


def played(scene: Coroutine[Any, Any, None]) -> None:
    asyncio.run(asyncio.wait_for(scene, PATIENCE_S))


def test_sixty_probes_at_once_make_one_look():
    parts = Parts(silent=True)

    async def scene() -> None:
        asked = readiness(parts, Clock())
        probes = [asyncio.create_task(asked.ready()) for _ in range(60)]
        await asyncio.to_thread(parts.reached.wait, PATIENCE_S)
        parts.let_go.set()
        assert {answer.workers for answer in await asyncio.gather(*probes)} == {1}

    played(scene())


@pytest.mark.parametrize("part", ["database", "storage"])
def test_a_part_that_does_not_answer_in_time_is_named_and_not_asked_again_meanwhile(part: str):
    parts = Parts(silent=True, at=part)

    async def scene() -> None:
        clock = Clock()
        asked = readiness(parts, clock, answer_within_s=1.5)
        first = asyncio.create_task(asked.ready())
        await asyncio.to_thread(parts.reached.wait, PATIENCE_S)
        clock.now += 30.0
        for _ in range(3):
            with pytest.raises(ProblemError) as caught:
                await asked.ready()
            assert caught.value.problem.code == f"{part}-unavailable"
            assert f"The {part} has not answered for 30 s." == caught.value.problem.detail
        with pytest.raises(ProblemError):
            await first
        assert parts.looks == 1
        parts.let_go.set()
        while not (last := asked.last) or not last.answer.done():
            await asyncio.sleep(0)
        assert (await asked.ready()).workers == 2

    played(scene())


@pytest.mark.parametrize(
    "fault", [EngineUnavailableError(), not_ready(code="no-worker", detail="None.")]
)
def test_what_a_look_finds_to_be_wrong_is_told_to_whoever_asks(fault: Exception):
    parts = Parts(fault=fault)

    async def scene() -> None:
        asked = readiness(parts, Clock())
        for _ in range(2):
            with pytest.raises(type(fault)) as caught:
                await asked.ready()
            assert caught.value is fault

    played(scene())
