"""The slots a worker's jobs run in, and when the worker looks for more jobs."""

import contextlib
import math
import threading
import time
from collections.abc import Callable, Collection, Iterator
from typing import Final

SETTLING_S: Final = 0.1
"""How long after a job's end to look for jobs without a pause: the engine counts the slot as taken
until it has recorded the end itself, which takes a database write or two."""

FULL_LOOK_S: Final = 1.0
"""How long a full worker waits before it looks anyway."""


class WorkerSlots:
    """One slot for each job that may run at the same time; decides when to look for jobs.

    Polling at a fixed interval would leave a slot empty for half an interval after every job, and
    would query the database while no slot is free.
    """

    def __init__(
        self, count: int, *, poll_s: float, monotonic: Callable[[], float] = time.monotonic
    ) -> None:
        self.count = count
        self._poll_s = poll_s
        self._monotonic = monotonic
        self._running: set[str] = set()
        self._changed = threading.Condition()
        self._ended = 0
        self._ended_at = -math.inf
        self._closed = False

    @contextlib.contextmanager
    def taken_by(self, job_id: str) -> Iterator[None]:
        """Give a job a slot while the context lasts."""
        with self._changed:
            self._running.add(job_id)
        try:
            yield
        finally:
            with self._changed:
                self._running.discard(job_id)
                self._ended += 1
                self._ended_at = self._monotonic()
                self._changed.notify_all()

    def held(self) -> Collection[str]:
        """The jobs that have a slot now."""
        with self._changed:
            return tuple(self._running)

    def await_turn(self) -> None:
        """Return when it is time to look for jobs.

        That is at once if a job has just ended, else after ``poll_s`` or when the next one ends;
        while all slots are taken, once a second.
        """
        with self._changed:
            if not self._changed.wait_for(self._has_free_slot, timeout=FULL_LOOK_S):
                return
            if self._monotonic() - self._ended_at >= SETTLING_S:
                before = self._ended
                self._changed.wait_for(
                    lambda: self._closed or self._ended != before, timeout=self._poll_s
                )

    @property
    def is_closed(self) -> bool:
        """Whether nobody is to wait for a turn any more."""
        return self._closed

    def close(self) -> None:
        """Release everybody who waits for a turn."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()

    def all_left(self, *, within_s: float) -> bool:
        """Wait until no job has a slot; returns whether that happened in time."""
        with self._changed:
            return self._changed.wait_for(lambda: not self._running, timeout=within_s)

    def _has_free_slot(self) -> bool:
        return self._closed or len(self._running) < self.count
