"""When keys were last used, written once a minute at most, and never while a request waits."""

import asyncio
import logging
import time
from collections.abc import Callable
from functools import partial
from typing import Final, Protocol

from anyio import CapacityLimiter, to_thread

from service.engine.port import EngineUnavailableError

LOG: Final = logging.getLogger(__name__)

BETWEEN_NOTES_S: Final = 60.0
"""Also the error of what is told: a use within this time after another is not written."""


class UseStore(Protocol):
    """Where the uses of keys are kept."""

    def note_use(self, identity: str, *, at: float, unless_since: float) -> None:
        """Keep that a key was used, unless a use since ``unless_since`` is known."""
        ...


class KeyUses:
    """Notes the use of keys; for use from a single event loop."""

    def __init__(self, store: UseStore, *, monotonic: Callable[[], float] = time.monotonic) -> None:
        self._store = store
        self._monotonic = monotonic
        self._noted_at: dict[str, float] = {}
        self._writing: set[asyncio.Task[None]] = set()
        self._limiter = CapacityLimiter(1)

    def note(self, identity: str) -> None:
        """Have it written that a key is used now, if that is due."""
        now = self._monotonic()
        if now - self._noted_at.get(identity, -BETWEEN_NOTES_S) < BETWEEN_NOTES_S:
            return
        self._noted_at[identity] = now
        task = asyncio.create_task(self._write(identity, time.time()))
        self._writing.add(task)
        task.add_done_callback(self._writing.discard)

    async def _write(self, identity: str, at: float) -> None:
        """Write one use; where the database is away, the next one that is due is written."""
        note = partial(self._store.note_use, identity, at=at, unless_since=at - BETWEEN_NOTES_S)
        try:
            await to_thread.run_sync(note, limiter=self._limiter)
        except EngineUnavailableError:
            LOG.debug("The use of key %s could not be noted.", identity)
        except Exception:
            LOG.exception("The use of key %s could not be noted.", identity)
