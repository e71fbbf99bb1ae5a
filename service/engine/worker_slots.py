"""The slots a worker's jobs run in, and when it is to look for more jobs."""

import contextlib
import math
import threading
import time
from collections.abc import Callable, Collection, Iterator
from typing import Final

SETTLING_S: Final = 0.1
"""For so long after a job's end jobs are looked for without a pause: the engine counts the slot as
taken until it has noted the end itself, which is a write to the database or two away."""

FULL_LOOK_S: Final = 1.0
"""How long a full worker waits before it gives a turn anyway."""


class WorkerSlots:
    """As many slots as jobs may run side by side; who looks for jobs waits here for a turn.

    Looking at a fixed pace alone leaves a slot empty for half of it after every job, and asks the
    database while there is no slot to be filled.
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
        """Let a job have a slot while the context lasts."""
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

        That is at once if a job has just ended, else after ``poll_s`` or at the next end; not while
        all slots are taken, but for a look a second.
        """
        with self._changed:
            if not self._changed.wait_for(self._has_free_slot, timeout=FULL_LOOK_S):
                return
            if self._monotonic() - self._ended_at >= SETTLING_S:
                before = self._ended
                self._changed.wait_for(
                    lambda: self._closed or self._ended != before, timeout=self._poll_s
                )

    def close(self) -> None:
        """Let nobody wait for a turn any more."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()

    def all_left(self, *, within_s: float) -> bool:
        """Wait until no job has a slot; say whether it came to that."""
        with self._changed:
            return self._changed.wait_for(lambda: not self._running, timeout=within_s)

    def _has_free_slot(self) -> bool:
        return self._closed or len(self._running) < self.count
