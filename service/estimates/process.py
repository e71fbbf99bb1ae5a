"""One estimator process as the API sees it: started, asked, replaced when it dies."""

import contextlib
import logging
import socket
import time
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Final

from service.estimates.messages import READY
from service.estimates.port import (
    EstimatorFailedError,
    EstimatorTimeoutError,
    EstimatorUnavailableError,
)
from service.estimates.starting import Start

LOG: Final = logging.getLogger(__name__)

READY_WITHIN_S: Final = 5.0
"""How long a question waits for a process that has just been started."""

ANSWER_WITHIN_S: Final = 10.0
"""A hundred times what an answer takes: a process that needs more is stuck, and is replaced."""

RESTART_PAUSE_S: Final = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class RawAnswer:
    """The JSON of an answer and the file that belongs to it."""

    text: bytes
    file: bytes


class EstimatorProcess:
    """A process and the socket to it; not thread-safe.

    The process holds the other end of the socket, and ends when this end is closed: if the API is
    killed, it does not stay behind.
    """

    def __init__(self, start: Start) -> None:
        self._start_with = start
        self._started_at = float("-inf")
        self._stopped = False
        self._start()

    def ask(self, task: bytes, file: bytes = b"", *, patient: bool = True) -> RawAnswer:
        """Send a question, with its file if any, and wait for the answer.

        Only a ``patient`` caller waits for a process that is starting.

        Raises
        ------
        EstimatorUnavailableError
            If the process is still starting or cannot start.
        EstimatorFailedError
            If it died while answering; the next one is started.
        EstimatorTimeoutError
            If it did not answer in time; the next one is started.
        """
        if self._process.has_ended():
            self._restart()
        self._await_ready(READY_WITHIN_S if patient else 0.0)
        try:
            self._connection.send_bytes(task)
            self._connection.send_bytes(file)
            if not self._connection.poll(ANSWER_WITHIN_S):
                LOG.error("An estimator did not answer within %.0f s.", ANSWER_WITHIN_S)
                self._end()
                self._start()
                raise EstimatorTimeoutError
            return RawAnswer(text=self._connection.recv_bytes(), file=self._connection.recv_bytes())
        except (EOFError, OSError) as error:
            code = self._end()
            LOG.exception("An estimator died over a question, exit code %d.", code)
            self._start()
            raise EstimatorFailedError from error

    def revive(self) -> None:
        """Restart the process if it has died, unless it is too early for that."""
        with contextlib.suppress(EstimatorUnavailableError):
            if not self._process.has_ended():
                self._await_ready(0.0)
            elif not self._stopped:
                LOG.error("An estimator died; starting another.")
                self._restart()

    def stop(self) -> None:
        """End the process; it is not replaced."""
        self._stopped = True
        self._end()

    def _await_ready(self, within_s: float) -> None:
        deadline = time.monotonic() + within_s
        try:
            while not self._ready:
                if not self._connection.poll(max(deadline - time.monotonic(), 0.0)):
                    raise EstimatorUnavailableError
                said = self._connection.recv_bytes()
                self._ready = said == READY
                if not self._ready:
                    self._process.named(int(said))
        except (EOFError, OSError) as error:
            self._process.kill()
            raise EstimatorUnavailableError from error

    def _start(self) -> None:
        if self._stopped:
            return
        ours, theirs = socket.socketpair()
        with theirs:
            self._process = self._start_with(theirs)
        self._connection: Connection = Connection(ours.detach())
        self._ready = False
        self._started_at = time.monotonic()

    def _restart(self) -> None:
        if time.monotonic() - self._started_at < RESTART_PAUSE_S:
            raise EstimatorUnavailableError
        self._end()
        self._start()

    def _end(self) -> int:
        with contextlib.suppress(EstimatorUnavailableError, OSError):
            # It may have said its number, without which it cannot be killed.
            self._await_ready(0.0)
        with contextlib.suppress(OSError):
            self._connection.close()
        return self._process.kill()
