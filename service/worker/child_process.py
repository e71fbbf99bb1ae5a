"""The worker's side of a job's process: find one, listen, stop it in time, note how it ended."""

import contextlib
import logging
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Final

from pydantic import ValidationError

from api_schemas.results import Artifact
from service.blobs import BlobMissingError, BlobStore, BlobsUnavailableError
from service.engine.port import Attempt, AttemptResult, Directive, Ending, JobRecord
from service.process.logs import current_log_context
from service.process.tracing import StageSpans, span
from service.settings import Settings
from service.worker import child
from service.worker.artifacts import describe_artifact
from service.worker.child_tasks import ChildSetup, ChildTask
from service.worker.endings import (
    ending_by,
    input_gone,
    is_unforeseen,
    no_process,
    no_storage,
    too_slow,
)
from service.worker.fork_server import ForkedProcesses, NoProcessError, killed_in_time
from service.worker.kept_children import Child, KeptChildren, Owner, owner_of
from service.worker.messages import (
    MESSAGES,
    DoneMessage,
    FileMessage,
    Message,
    ProblemMessage,
    ProgressMessage,
)
from service.worker.retrying import retry_while_storage_is_away
from service.worker.throttled_progress import ThrottledProgress

LOG: Final = logging.getLogger(__name__)

LARGEST_FILE_BYTES: Final = 256 * 1024 * 1024
"""A child that sends more has been taken over by its picture."""

WATCHDOG_S: Final = 1.0
"""Beyond the time limit, a child that stalls in the middle of a message is killed from outside."""

JOIN_S: Final = 1.0
"""How long the exit code of a child that has closed its pipe is waited for."""

CRASHES: Final = 2
"""In a row, after which the fork server is replaced; a job has three attempts by default."""

STOPPED: Final = {
    Directive.CANCELED: AttemptResult(ending=Ending.CANCELED),
    Directive.SUPERSEDED: AttemptResult(ending=Ending.SUPERSEDED),
}


class ChildRunner:
    """Runs attempts in child processes, forked from a server that has the numerics loaded.

    One that has done a job well runs the next one, if that is its owner's and follows at once.
    """

    def __init__(
        self,
        settings: Settings,
        blobs: BlobStore,
        processes: ForkedProcesses,
        *,
        pipeline: str,
    ) -> None:
        self._settings = settings
        self._blobs = blobs
        self._pipeline = pipeline
        self._processes = processes
        self._kept = KeptChildren(jobs=settings.child_jobs)
        self._crashes = 0

    def run(self, attempt: Attempt) -> AttemptResult:
        """Run one attempt to its end: done, failed, canceled, out of time or crashed."""
        try:
            result = self._run(attempt)
            self._suspect_server(result)
            return result
        except BlobMissingError:
            LOG.warning("The input of the job is gone.")
            return AttemptResult(ending=Ending.FAILED, problem=input_gone())
        except BlobsUnavailableError as error:
            LOG.error("The storage did not come back (%s).", error)
            return AttemptResult(ending=Ending.FAILED, problem=no_storage(error))
        except NoProcessError as error:
            LOG.error("No process can be started (%s).", error)
            return AttemptResult(ending=Ending.FAILED, problem=no_process())

    def _suspect_server(self, result: AttemptResult) -> None:
        """Replace the fork server when processes crash in a row: what it shares may be damaged.

        A file that it has mapped may have been truncated since, over which every process would die.
        """
        self._crashes = self._crashes + 1 if result.ending is Ending.CRASHED else 0
        if self._crashes >= CRASHES:
            LOG.warning("Processes of jobs crash in a row: the fork server is replaced.")
            self._crashes = 0
            self._processes.replace_server()

    def _run(self, attempt: Attempt) -> AttemptResult:
        deadline = time.monotonic() + self._settings.job_time_limit_s
        owner = owner_of(attempt.job)
        # Whatever ended the attempt before is not to have been left in a process.
        kept = self._kept.take(owner) if attempt.job.attempt == 1 else None
        if kept is not None:
            result = self._run_in(kept, owner, attempt, deadline)
            if not is_unforeseen(result):
                return result
            LOG.warning("The job failed in a process that had run others: it gets a new one.")
        return self._run_in(self._start(), owner, attempt, deadline)

    def _run_in(
        self, child: Child, owner: Owner, attempt: Attempt, deadline: float
    ) -> AttemptResult:
        try:
            computed = self._compute(child, attempt, deadline)
        except Exception:
            child.end()
            raise
        if isinstance(computed, AttemptResult):
            child.end()
            return computed
        self._kept.keep(child, owner)
        attempt.leave_slot()
        directive = attempt.directive()
        if directive is not Directive.CONTINUE:
            return STOPPED[directive]
        return AttemptResult(
            ending=Ending.SUCCEEDED,
            artifacts=self._store(attempt.job.id, computed.files),
            stage_seconds=computed.stage_seconds,
        )

    def _compute(
        self, child: Child, attempt: Attempt, deadline: float
    ) -> "_Computed | AttemptResult":
        try:
            with (
                killed_in_time(child.process, deadline - time.monotonic() + WATCHDOG_S),
                contextlib.closing(StageSpans()) as spans,
            ):
                child.give(_task(attempt.job), self._input(attempt.job))
                return self._follow(attempt, child.connection, spans, deadline=deadline)
        except (EOFError, OSError, ValidationError):
            # The pipe broke, or what came through it was no message of ours.
            if time.monotonic() >= deadline:
                return self._timed_out()
            child.process.join(JOIN_S)
            LOG.warning("The process of the job died, exit code %s.", child.process.exitcode)
            return AttemptResult(ending=Ending.CRASHED)

    def _input(self, job: JobRecord) -> Iterator[bytes]:
        read = retry_while_storage_is_away(self._blobs.get)
        for part in (job.options, *job.inputs.values()):
            yield read(job.id, part.digest)

    def _timed_out(self) -> AttemptResult:
        return AttemptResult(
            ending=Ending.TIMED_OUT, problem=too_slow(self._settings.job_time_limit_s)
        )

    def _start(self) -> Child:
        setup = ChildSetup(
            pipeline=self._pipeline,
            max_pixels=self._settings.max_pixels,
            models=self._settings.models_dir,
            detector=self._settings.detector_dir,
            memory_mb=self._settings.child_memory_mb,
            log_level=self._settings.log_level,
            log_format=self._settings.log_format,
        )
        return Child(*self._processes.start(child.work, setup))

    def _follow(
        self, attempt: Attempt, connection: Connection, spans: StageSpans, *, deadline: float
    ) -> "_Computed | AttemptResult":
        progress = ThrottledProgress(attempt, interval_s=self._settings.progress_interval_s)
        next_look = 0.0
        files: dict[str, bytes] = {}
        while True:
            message = _receive(connection, timeout_s=self._settings.cancel_poll_s)
            if isinstance(message, FileMessage):
                files[message.name] = connection.recv_bytes(LARGEST_FILE_BYTES)
            if isinstance(message, DoneMessage):
                return _Computed(files=files, stage_seconds=message.stage_seconds)
            if isinstance(message, ProblemMessage):
                return AttemptResult(ending=ending_by(message.problem), problem=message.problem)
            if isinstance(message, ProgressMessage):
                progress.take(message)
                spans.enter(message.stage)
            directive = progress.store_if_due()
            now = time.monotonic()
            if now >= deadline:
                return self._timed_out()
            if directive is None and now >= next_look:
                directive = attempt.directive()
            if directive is not None:
                next_look = now + self._settings.cancel_poll_s
                if directive is not Directive.CONTINUE:
                    return STOPPED[directive]

    def _store(self, scope: str, files: Mapping[str, bytes]) -> tuple[Artifact, ...]:
        put_all = retry_while_storage_is_away(self._blobs.put_all)
        with span("store result"):
            digests = put_all(scope, list(files.values()))
        return tuple(
            describe_artifact(name, content, digest=digest)
            for (name, content), digest in zip(files.items(), digests, strict=True)
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Computed:
    """A result that has yet to be stored."""

    files: Mapping[str, bytes]
    stage_seconds: Mapping[str, float]


def _task(job: JobRecord) -> ChildTask:
    return ChildTask(
        kind=job.kind,
        inputs=tuple(job.inputs),
        log_context=dict(current_log_context()),
        derived_from=job.parent,
    )


def _receive(connection: Connection, *, timeout_s: float) -> Message | None:
    if not connection.poll(timeout_s):
        return None
    return MESSAGES.validate_json(connection.recv_bytes())
