"""Wakes everybody who waits for a job's next event: one query for all, however many."""

import asyncio
import logging
import threading
from collections import Counter
from typing import Final

from starlette.concurrency import run_in_threadpool

from service.jobs.engine import JobEngine
from service.jobs.records import EngineUnavailableError

LOG: Final = logging.getLogger(__name__)

POLL_S: Final = 0.1
PAUSE_AFTER_FAILURE_S: Final = 1.0


class EventFeed:
    """Follows the last event number of every job that someone is waiting for."""

    def __init__(self, engine: JobEngine, draining: threading.Event) -> None:
        self._engine = engine
        self._draining = draining
        self._waiting: Counter[str] = Counter()
        self._last: dict[str, int] = {}
        self._changed = asyncio.Condition()

    async def wait_beyond(self, job_id: str, number: int, *, timeout_s: float) -> None:
        """Return when the job has an event numbered above ``number``, is gone, or time is up.

        Returns at once if the process is being stopped.
        """
        self._waiting[job_id] += 1
        try:
            async with asyncio.timeout(timeout_s), self._changed:
                await self._changed.wait_for(
                    lambda: self.is_ending or self._last.get(job_id, number) != number
                )
        except TimeoutError:
            return
        finally:
            self._waiting[job_id] -= 1
            if self._waiting[job_id] <= 0:
                del self._waiting[job_id]
                self._last.pop(job_id, None)

    @property
    def is_ending(self) -> bool:
        """Whether the process is stopping: clients that follow a job should ask another process."""
        return self._draining.is_set()

    async def run(self) -> None:
        """Poll until canceled; idle while nobody waits."""
        while True:
            await asyncio.sleep(POLL_S)
            if self.is_ending:
                async with self._changed:
                    self._changed.notify_all()
                continue
            waiting = list(self._waiting)
            if not waiting:
                continue
            try:
                numbers = await run_in_threadpool(self._engine.last_events, waiting)
            except Exception as error:
                # Waiting requests run into their timeouts and query the database themselves.
                if isinstance(error, EngineUnavailableError):
                    LOG.warning("The database is not available; events are told later.")
                else:
                    LOG.exception("Looking for events failed.")
                await asyncio.sleep(PAUSE_AFTER_FAILURE_S)
                continue
            latest = {job_id: numbers.get(job_id, GONE) for job_id in waiting}
            if latest.items() - self._last.items():
                self._last |= latest
                async with self._changed:
                    self._changed.notify_all()


GONE: Final = -1
"""Stands for the last event of a job that no longer exists."""
