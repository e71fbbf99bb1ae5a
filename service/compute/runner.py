"""The worker's side of a job: find a child, listen, stop it in time, note how it ended."""

import logging
import time
from dataclasses import replace
from typing import Final

from pydantic import ValidationError

from api_schemas.problems import Problem, problem
from api_schemas.results import ResultFile
from service.compute.fork_server import Child, ForkServer, NoProcessError
from service.compute.messages import (
    DoneMessage,
    FaultMessage,
    ProblemMessage,
    ProgressMessage,
    Received,
    TaskMessage,
)
from service.compute.tasks import OPTIONS, PRODUCT, ChildSetup, Parts, describe_file
from service.jobs.attempts import Attempt
from service.jobs.blobs import (
    BlobMissingError,
    BlobStore,
    BlobsUnavailableError,
    StorageFullError,
    retry_while_storage_is_away,
)
from service.jobs.records import (
    FIT,
    AttemptResult,
    Directive,
    Ending,
    JobRecord,
    Report,
)
from service.process.logs import current_log_context
from service.settings import Settings

LOG: Final = logging.getLogger(__name__)

CANCEL_POLL_S: Final = 0.1
"""Pause between two looks of a running fit whether it was canceled."""

WATCHDOG_S: Final = 1.0
"""Beyond the time limit, a child that stalls in the middle of a message is killed from outside."""

EXIT_S: Final = 1.0
"""Wait for the exit code of a child that has closed its pipe."""

STORED_EVERY_S: Final = 0.2
"""The shortest time between two stored reports of one stage."""

STOPPED: Final = {
    Directive.CANCELED: AttemptResult(ending=Ending.CANCELED),
    Directive.SUPERSEDED: AttemptResult(ending=Ending.SUPERSEDED),
}

FAULT: Final = problem(
    "fit-failed",
    detail="An unexpected fault ended the job.",
    remedy="Report it with the job's id; other jobs are not affected.",
)
OUT_OF_MEMORY: Final = problem(
    "fit-failed",
    code="out-of-memory",
    detail="The job needed more memory than one job may have.",
    remedy="Send a smaller picture, or ask for less at once.",
)
INPUT_GONE: Final = problem(
    "fit-failed",
    code="input-gone",
    detail="What the job was made of is gone.",
    remedy="Post it again.",
)
"""The job was erased during the attempt, or somebody emptied the storage by hand."""

NO_PROCESS: Final = problem(
    "fit-failed",
    code="no-process",
    detail="No process could be started for the job.",
    remedy="Post it again once the service reports itself ready.",
)
"""The machine had no room for a process for longer than the worker waits."""


def no_storage(error: BlobsUnavailableError) -> Problem:
    """The problem of storage that was full or away for longer than the worker waits."""
    full = isinstance(error, StorageFullError)
    return problem(
        "fit-failed",
        code="storage-full" if full else "storage-unavailable",
        detail="The result could not be stored.",
        remedy="Post it again once the service reports itself ready.",
    )


def too_slow(limit_s: float) -> Problem:
    """The problem of a job that exceeded its time limit."""
    return problem(
        "time-limit-exceeded",
        detail=f"The job was stopped after {limit_s:g} s.",
        remedy="Send a smaller picture, choose the optimizer gauss_newton, or ask for less.",
    )


class JobRunner:
    """Runs each attempt in a child of its own."""

    def __init__(
        self, settings: Settings, blobs: BlobStore, server: ForkServer, setup: ChildSetup
    ) -> None:
        self._time_limit_s = settings.job_time_limit_s
        self._blobs = blobs
        self._server = server
        self._setup = setup

    def run(self, attempt: Attempt) -> AttemptResult:
        """Run one attempt to its end: done, failed, canceled, out of time or crashed."""
        try:
            return self._run(attempt)
        except BlobMissingError:
            LOG.warning("The input of the job is gone.")
            return _failed(INPUT_GONE)
        except BlobsUnavailableError as error:
            LOG.error("The storage did not come back (%s).", error)
            return _failed(no_storage(error))
        except NoProcessError as error:
            LOG.error("No process can be started (%s).", error)
            return _failed(NO_PROCESS)

    def _run(self, attempt: Attempt) -> AttemptResult:
        deadline = time.monotonic() + self._time_limit_s
        child = self._server.start_child(self._setup)
        try:
            computed = self._compute(child, attempt, deadline)
        finally:
            child.end()
        if isinstance(computed, AttemptResult):
            return computed
        attempt.leave_slot()
        directive = attempt.directive()
        if directive is not Directive.CONTINUE:
            return STOPPED[directive]
        return AttemptResult(
            ending=Ending.SUCCEEDED,
            files=self._store(attempt.job.scope, computed),
        )

    def _compute(self, child: Child, attempt: Attempt, deadline: float) -> Parts | AttemptResult:
        try:
            with child.killed_in_time(deadline - time.monotonic() + WATCHDOG_S):
                self._give(child, attempt.job)
                return self._follow(attempt, child, deadline=deadline)
        except (EOFError, OSError, ValidationError):
            # The pipe broke, or what came through it was no message of ours.
            if time.monotonic() >= deadline:
                return self._timed_out()
            LOG.warning("The process of the job died, exit code %s.", child.exit_code(EXIT_S))
            return AttemptResult(ending=Ending.CRASHED)

    def _give(self, child: Child, job: JobRecord) -> None:
        stored = {OPTIONS: job.options, **job.inputs}
        task = TaskMessage(
            task=FIT if job.parent is None else PRODUCT,
            parts=tuple(stored),
            log_context=dict(current_log_context()),
        )
        read = retry_while_storage_is_away(self._blobs.get)
        # One after the other, and sent at once: together they may be large.
        child.give(task, (read(job.scope, part.digest) for part in stored.values()))

    def _timed_out(self) -> AttemptResult:
        return AttemptResult(ending=Ending.TIMED_OUT, problem=too_slow(self._time_limit_s))

    def _follow(self, attempt: Attempt, child: Child, *, deadline: float) -> Parts | AttemptResult:
        progress = ThrottledProgress(attempt)
        next_look = 0.0
        while True:
            received = child.receive(CANCEL_POLL_S)
            if received is not None:
                if not isinstance(received.message, ProgressMessage):
                    return _ended(received)
                progress.take(received.message.report)
            directive = progress.store_if_due()
            now = time.monotonic()
            if now >= deadline:
                return self._timed_out()
            if directive is None and now >= next_look:
                directive = attempt.directive()
            if directive is not None:
                next_look = now + CANCEL_POLL_S
                if directive is not Directive.CONTINUE:
                    return STOPPED[directive]

    def _store(self, scope: str, files: Parts) -> tuple[ResultFile, ...]:
        put_all = retry_while_storage_is_away(self._blobs.put_all)
        digests = put_all(scope, list(files.values()))
        return tuple(
            describe_file(name, content, digest=digest)
            for (name, content), digest in zip(files.items(), digests, strict=True)
        )


def _failed(reason: Problem) -> AttemptResult:
    return AttemptResult(ending=Ending.FAILED, problem=reason)


def _ended(received: Received) -> Parts | AttemptResult:
    match received.message:
        case DoneMessage():
            return received.parts
        case ProblemMessage(problem=reason):
            return _failed(reason)
        case FaultMessage(out_of_memory=True):
            return _failed(OUT_OF_MEMORY)
        case FaultMessage():
            return _failed(FAULT)
        case _:
            message = f"a child sent a message of kind {received.message.kind}"
            raise OSError(message)


class ThrottledProgress:
    """Keeps the latest report back until the last stored one is old enough."""

    def __init__(self, attempt: Attempt) -> None:
        self._attempt = attempt
        self._due = 0.0
        self._news: tuple[str, int | None] | None = None
        self._latest: Report | None = None

    def take(self, report: Report) -> None:
        """Take a report that came."""
        news = (report.stage, report.view)
        if news != self._news:
            # A new stage, or the next picture, is news: it does not wait.
            self._news, self._due = news, 0.0
        self._latest = report

    def store_if_due(self) -> Directive | None:
        """Store the latest report, if there is one and it is time; then say whether to go on."""
        now = time.monotonic()
        if self._latest is None or now < self._due:
            return None
        report, self._latest, self._due = self._latest, None, now + STORED_EVERY_S
        return self._attempt.report(replace(report, progress=min(max(report.progress, 0.0), 1.0)))
