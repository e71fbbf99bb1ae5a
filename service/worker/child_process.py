"""The worker's side of a child process: start it, listen, stop it in time, note how it ended."""

import logging
import time
from multiprocessing import forkserver, get_context
from multiprocessing.connection import Connection
from multiprocessing.context import ForkServerContext, ForkServerProcess
from typing import Final

from api_schemas.body_models import BodyModels
from api_schemas.problems import Problem, problem
from service.engine.port import Attempt, AttemptResult, Directive, Ending, Report
from service.settings import Settings
from service.worker import child
from service.worker.messages import (
    MESSAGES,
    DescriptionMessage,
    DoneMessage,
    Message,
    ProblemMessage,
    ProgressMessage,
)

LOG: Final = logging.getLogger(__name__)

STOPPED: Final = {
    Directive.CANCELED: AttemptResult(ending=Ending.CANCELED),
    Directive.SUPERSEDED: AttemptResult(ending=Ending.SUPERSEDED),
}


class ChildRunner:
    """Runs attempts in child processes, forked from a server that has the numerics loaded.

    A fork takes 0.02 s where a fresh interpreter takes most of a second, and the server itself
    stays without threads, which is what makes forking safe.
    """

    def __init__(self, settings: Settings, *, pipeline: str, preload: str) -> None:
        self._settings = settings
        self._pipeline = pipeline
        self._context: ForkServerContext = get_context("forkserver")
        self._context.set_forkserver_preload([preload])

    def begin_preloading(self) -> None:
        """Start the fork server, which loads the numerics by itself."""
        forkserver.ensure_running()

    def describe(self) -> BodyModels:
        """Ask a child which body models there are."""
        connection, process = self._start_describing()
        try:
            message = MESSAGES.validate_json(connection.recv_bytes())
        finally:
            _end(connection, process)
        assert isinstance(message, DescriptionMessage)
        return message.body_models

    def run(self, attempt: Attempt) -> AttemptResult:
        """Run one attempt to its end: done, failed, canceled, out of time or crashed."""
        connection, process = self._start_fit(attempt)
        try:
            return self._follow(attempt, connection, process)
        finally:
            _end(connection, process)

    def _start_describing(self) -> tuple[Connection, ForkServerProcess]:
        ours, theirs = self._context.Pipe()
        process = self._context.Process(target=child.describe, args=(self._pipeline, theirs))
        process.start()
        theirs.close()
        return ours, process

    def _start_fit(self, attempt: Attempt) -> tuple[Connection, ForkServerProcess]:
        job = attempt.job
        task = child.ChildTask(
            pipeline=self._pipeline,
            blob_root=str(self._settings.blob_dir),
            scope=job.id,
            options=job.options,
            image=job.image.digest,
            mask=job.mask.digest if job.mask else None,
            max_pixels=self._settings.max_pixels,
            memory_mb=self._settings.child_memory_mb,
        )
        ours, theirs = self._context.Pipe()
        process = self._context.Process(target=child.fit, args=(task, theirs))
        process.start()
        theirs.close()
        return ours, process

    def _follow(
        self, attempt: Attempt, connection: Connection, process: ForkServerProcess
    ) -> AttemptResult:
        deadline = time.monotonic() + self._settings.job_time_limit_s
        progress = _ThrottledProgress(attempt, interval_s=self._settings.progress_interval_s)
        next_look = 0.0
        while True:
            try:
                message = _receive(connection, timeout_s=self._settings.cancel_poll_s)
            except (EOFError, ConnectionResetError):
                process.join()
                LOG.warning(
                    "job=%s: its process died, exit code %s.", attempt.job.id, process.exitcode
                )
                return AttemptResult(ending=Ending.CRASHED)
            if isinstance(message, DoneMessage):
                return AttemptResult(ending=Ending.SUCCEEDED, artifacts=message.artifacts)
            if isinstance(message, ProblemMessage):
                return AttemptResult(ending=Ending.FAILED, problem=message.problem)
            if isinstance(message, ProgressMessage):
                progress.take(message)
            progress.store_if_due()
            now = time.monotonic()
            if now >= deadline:
                return AttemptResult(
                    ending=Ending.TIMED_OUT, problem=_too_slow(self._settings.job_time_limit_s)
                )
            if now >= next_look:
                next_look = now + self._settings.cancel_poll_s
                directive = attempt.directive()
                if directive is not Directive.CONTINUE:
                    return STOPPED[directive]


class _ThrottledProgress:
    """Keeps the latest report back until the last stored one is old enough."""

    def __init__(self, attempt: Attempt, *, interval_s: float) -> None:
        self._attempt = attempt
        self._interval_s = interval_s
        self._due = 0.0
        self._stage: str | None = None
        self._latest: ProgressMessage | None = None

    def take(self, message: ProgressMessage) -> None:
        if message.stage != self._stage:
            # A new stage is news: it does not wait.
            self._stage = message.stage
            self._due = 0.0
        self._latest = message

    def store_if_due(self) -> None:
        now = time.monotonic()
        if self._latest is None or now < self._due:
            return
        self._attempt.report(
            Report(
                stage=self._latest.stage,
                progress=min(max(self._latest.progress, 0.0), 1.0),
                energies=self._latest.energies,
            )
        )
        self._latest = None
        self._due = now + self._interval_s


def _receive(connection: Connection, *, timeout_s: float) -> Message | None:
    if not connection.poll(timeout_s):
        return None
    return MESSAGES.validate_json(connection.recv_bytes())


def _end(connection: Connection, process: ForkServerProcess) -> None:
    connection.close()
    process.kill()
    process.join()
    process.close()


def _too_slow(limit_s: float) -> Problem:
    return problem(
        "time-limit-exceeded",
        detail=f"The fit was stopped after {limit_s:g} s.",
        remedy="Send a smaller picture, or choose the optimizer gauss_newton.",
    )
