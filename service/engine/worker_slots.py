"""The slots a worker's jobs run in, and when the worker looks for more jobs."""

import contextlib
import math
import threading
import time
from collections.abc import Callable, Collection, Iterator
from typing import Final

SETTLING_S: Final = 0.1
"""How long to look for jobs without a pause after a slot was left: what comes next may be about to
be submitted, and the engine counts a job until it has recorded its end, a database write or two."""

FULL_LOOK_S: Final = 1.0
"""How long a full worker waits before it looks anyway."""


class WorkerSlots:
    """One slot for each job that may run at the same time; decides when to look for jobs.

    Polling at a fixed interval would leave a slot empty for half an interval after every job, and
    would query the database while no slot is free. A job leaves its slot when all that is left of
    it is to store its result; no more jobs may be about that than there are slots.
    """

    def __init__(
        self, count: int, *, poll_s: float, monotonic: Callable[[], float] = time.monotonic
    ) -> None:
        self.count = count
        self._poll_s = poll_s
        self._monotonic = monotonic
        self._running: set[str] = set()
        self._leaving: set[str] = set()
        self._is_looking = False
        self._changed = threading.Condition()
        self._turns = 0
        self._left_at = -math.inf
        self._closed = False

    @contextlib.contextmanager
    def taken_by(self, job_id: str) -> Iterator[None]:
        """Give a job a slot while the context lasts, or until it leaves it."""
        with self._changed:
            self._running.add(job_id)
        try:
            yield
        finally:
            with self._changed:
                if job_id in self._leaving:
                    self._changed.wait_for(self._may_end, timeout=FULL_LOOK_S)
                self._running.discard(job_id)
                self._leaving.discard(job_id)
                self._give_turn()

    def leave(self, job_id: str) -> None:
        """Leave the slot to another job, while the result of this one is stored."""
        with self._changed:
            self._running.discard(job_id)
            self._leaving.add(job_id)
            self._give_turn()

    def held(self) -> Collection[str]:
        """The jobs that have a slot now, or whose results are being stored."""
        with self._changed:
            return (*self._running, *self._leaving)

    def claimable(self) -> int:
        """How many jobs the engine may have begun after the look that begins now.

        Those that have left their slots still count among them. None of them ends before
        :meth:`end_look`: a job too many would be begun in its place.
        """
        with self._changed:
            self._is_looking = True
            return min(self.count + len(self._leaving), 2 * self.count)

    def end_look(self) -> None:
        """Let jobs end again that have left their slots."""
        with self._changed:
            self._is_looking = False
            self._changed.notify_all()

    def await_turn(self) -> None:
        """Return when it is time to look for jobs.

        That is at once if a slot has just been left, else after ``poll_s`` or when the next one is;
        while all slots are taken, once a second.
        """
        with self._changed:
            if not self._changed.wait_for(self._has_free_slot, timeout=FULL_LOOK_S):
                return
            if self._monotonic() - self._left_at >= SETTLING_S:
                before = self._turns
                self._changed.wait_for(
                    lambda: self._closed or self._turns != before, timeout=self._poll_s
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
        """Wait until all jobs have ended; returns whether that happened in time."""
        with self._changed:
            return self._changed.wait_for(
                lambda: not self._running and not self._leaving, timeout=within_s
            )

    def _has_free_slot(self) -> bool:
        running = len(self._running)
        return self._closed or (
            running < self.count and running + len(self._leaving) < 2 * self.count
        )

    def _may_end(self) -> bool:
        return self._closed or not self._is_looking

    def _give_turn(self) -> None:
        self._turns += 1
        self._left_at = self._monotonic()
        self._changed.notify_all()
