"""The slots a worker's jobs run in, and when the worker looks for more jobs."""

import logging
import threading
import time
from collections.abc import Callable, Collection
from typing import Final

LOG: Final = logging.getLogger(__name__)

FAULT_PAUSE_S: Final = 1.0
"""Pause after a look that failed, seconds."""


class WorkerSlots:
    """One slot for each job that may run at the same time; decides when to look for jobs.

    Looking at a fixed pace would leave a slot empty for half an interval after every job, and would
    query the database while no slot is free. A job leaves its slot when all that is left of it is
    to store its result; no more jobs may be about that than there are slots.
    """

    def __init__(self, count: int, *, poll_s: float) -> None:
        self._count = count
        self._poll_s = poll_s
        self._taken: set[str] = set()
        self._running: set[str] = set()
        self._leaving: set[str] = set()
        self._changed = threading.Condition()
        self._is_left = False
        self._closed = False

    def keep_filled(self, begin_waiting_jobs: Callable[[], bool]) -> None:
        """Begin jobs whenever a slot is free, until the slots are closed.

        ``begin_waiting_jobs`` returns whether any waited. Whatever it raises is logged, and it is
        called again: a worker that looks for nothing would seem healthy and do nothing.
        """
        while True:
            self.await_vacancy()
            if self.is_closed:
                return
            try:
                any_waited = begin_waiting_jobs()
            except Exception:
                LOG.exception("Waiting jobs could not be looked for; tried again.")
                time.sleep(FAULT_PAUSE_S)
                any_waited = False
            if not any_waited:
                self.await_next_look()

    def take(self, job_id: str) -> None:
        """Give a slot to a job that was claimed and is about to begin."""
        with self._changed:
            self._taken.add(job_id)

    def begin(self, job_id: str) -> None:
        """Note that the job has begun."""
        with self._changed:
            self._taken.discard(job_id)
            self._running.add(job_id)

    def leave(self, job_id: str) -> None:
        """Leave the slot to another job, while the result of this one is stored."""
        with self._changed:
            self._running.discard(job_id)
            self._leaving.add(job_id)
            self._report_left()

    def free(self, job_id: str) -> None:
        """Forget a job: it has ended, or will not begin."""
        with self._changed:
            for jobs in (self._taken, self._running, self._leaving):
                jobs.discard(job_id)
            self._report_left()

    def held(self) -> Collection[str]:
        """The jobs that have a slot now, or whose results are being stored."""
        with self._changed:
            return (*self._taken, *self._running, *self._leaving)

    def not_begun(self) -> Collection[str]:
        """The jobs that have a slot and have not begun."""
        with self._changed:
            return tuple(self._taken)

    def vacant(self) -> int:
        """Number of jobs that may begin now; 0 once the slots are closed."""
        with self._changed:
            if self._closed:
                return 0
            running = len(self._taken) + len(self._running)
            return min(self._count - running, 2 * self._count - running - len(self._leaving))

    def await_vacancy(self) -> None:
        """Return when a slot is free, or when the slots are closed."""
        with self._changed:
            self._changed.wait_for(lambda: self._closed or self.vacant() > 0)

    def await_next_look(self) -> None:
        """Return when it is time to look once more, after a look that found nothing.

        That is at once if a slot has been left since the last time, else after ``poll_s`` or when
        one is.
        """
        with self._changed:
            self._changed.wait_for(lambda: self._closed or self._is_left, timeout=self._poll_s)
            self._is_left = False

    @property
    def is_closed(self) -> bool:
        """Whether no job is to begin any more."""
        return self._closed

    def close(self) -> None:
        """Begin no more jobs, and release everybody who waits."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()

    def all_left(self, *, within_s: float) -> bool:
        """Wait until all jobs have ended; returns whether that happened in time."""
        with self._changed:
            return self._changed.wait_for(
                lambda: not (self._taken or self._running or self._leaving), timeout=within_s
            )

    def _report_left(self) -> None:
        self._is_left = True
        self._changed.notify_all()
