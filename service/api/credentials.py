"""A process's cache of keys, so that a request costs no query.

Entries live for a few seconds. A key's last use is written at most once a minute, and no request
waits for it.
"""

import asyncio
import logging
import time
from collections.abc import Callable
from functools import partial
from typing import Final

from anyio import CapacityLimiter, to_thread

from service.jobs.keys import ApiKey, KeyRing, hash_key
from service.jobs.records import EngineUnavailableError

LOG: Final = logging.getLogger(__name__)

REFRESH_S: Final = 5.0
"""Within this time at the latest a key is refused that was revoked."""

RETRY_UNKNOWN_S: Final = 0.5
"""Unknown keys cause at most one query per this time, all of them together."""

BETWEEN_NOTES_S: Final = 60.0
"""Also the error of what is told: a use within this time after another is not written."""


class KnownKeys:
    """The valid keys, cached for a few seconds, so that a request costs no query."""

    def __init__(self, source: KeyRing, *, monotonic: Callable[[], float] = time.monotonic) -> None:
        self._source = source
        self._monotonic = monotonic
        self._by_hash: dict[str, ApiKey] = {}
        self._read_at: float | None = None

    def find(self, presented: str) -> ApiKey | None:
        """Return the valid key that was presented; None if there is no such key.

        Raises
        ------
        EngineUnavailableError
            If the database is unavailable and nothing is cached yet.
        """
        secret_hash = hash_key(presented)
        age = None if self._read_at is None else self._monotonic() - self._read_at
        known = self._by_hash.get(secret_hash)
        if age is None or age >= (REFRESH_S if known is not None else RETRY_UNKNOWN_S):
            self._refresh()
            known = self._by_hash.get(secret_hash)
        return known

    def _refresh(self) -> None:
        try:
            keys = self._source.all_keys()
        except EngineUnavailableError:
            # A key valid a moment ago is still accepted; the request itself will fail next.
            if self._read_at is None:
                raise
            return
        self._by_hash = {key.secret_hash: key for key in keys if key.revoked_at is None}
        self._read_at = self._monotonic()


class KeyUses:
    """Notes the use of keys; for use from a single event loop."""

    def __init__(self, store: KeyRing, *, monotonic: Callable[[], float] = time.monotonic) -> None:
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
