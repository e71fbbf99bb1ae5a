"""Inside the child process: the only place where a caller's picture is decoded.

It runs one job after the other, as many as its worker gives it, all of one owner. Input and files
of the results go through the pipe to its worker, so it needs neither database nor storage. It dies
with its worker: a thread reads the pipe, on which there is nothing but the next job, and the end of
the pipe is the end of the worker (a signal on the parent's death does not serve, the parent being
the fork server).
"""

import faulthandler
import logging
import os
import resource
import signal
import threading
import time
from collections.abc import Callable
from multiprocessing.connection import Connection
from pathlib import Path
from queue import SimpleQueue
from typing import Final
from uuid import UUID

from api_schemas.problems import field_problem
from service.engine.port import Report
from service.process.logs import configure_logging, log_context
from service.process.naming import call_process
from service.worker.artifacts import with_result_document
from service.worker.child_inputs import derivation_input, fit_input
from service.worker.child_tasks import ChildSetup, GivenTask, take
from service.worker.endings import fault, out_of_memory
from service.worker.messages import (
    MESSAGES,
    DoneMessage,
    FileMessage,
    Message,
    ProblemMessage,
    ProgressMessage,
)
from service.worker.pipeline_port import (
    Pipeline,
    ProblemError,
    UnusableInputError,
    load_pipeline,
)

LOG: Final = logging.getLogger(__name__)

NICENESS: Final = 5
"""Fits give way to the API on the same machine."""

OOM_SCORE: Final = 500
"""When memory runs out, the kernel is to take the fit and not the worker."""

TOLD_EVERY_S: Final = 0.05
"""A search reports every few milliseconds, and the worker is woken by each."""


def work(setup: ChildSetup, connection: Connection) -> None:
    """Run the jobs that come, and tell the worker of each how it went."""
    call_process("job")
    _configure_logging(setup)
    _limit(setup.memory_mb)
    jobs = _follow_worker(connection)
    while True:
        # Nothing here holds a job on to the next: it goes out of scope with the call.
        _work_on(jobs.get(), setup, connection)


def _work_on(given: GivenTask, setup: ChildSetup, connection: Connection) -> None:
    with log_context(**given.task.log_context):
        _send(connection, _answered(given, setup, connection))


def _answered(given: GivenTask, setup: ChildSetup, connection: Connection) -> Message:
    try:
        return _done(given, setup, connection, load_pipeline(setup.pipeline))
    except ProblemError as error:
        return ProblemMessage(problem=error.problem)
    except UnusableInputError as error:
        return ProblemMessage(problem=field_problem("unusable-input", error.error))
    except MemoryError:
        return ProblemMessage(problem=out_of_memory())
    except Exception:
        LOG.exception("The job failed.")
        return ProblemMessage(problem=fault())


def _done(
    given: GivenTask, setup: ChildSetup, connection: Connection, pipeline: Pipeline
) -> DoneMessage:
    observe = _telling(connection)
    made_of = given.task.derived_from
    if made_of is None:
        fitted = pipeline.run(fit_input(setup, given), observe)
        files = with_result_document(fitted.result, fitted.artifacts)
        stage_seconds = fitted.result.stage_seconds
    else:
        derived = pipeline.derive(derivation_input(setup, given, UUID(made_of)), observe)
        files = with_result_document(derived.result, derived.artifacts)
        stage_seconds = {}
    for name, content in files.items():
        _send(connection, FileMessage(name=name))
        connection.send_bytes(content)
    return DoneMessage(stage_seconds=stage_seconds)


def _telling(connection: Connection) -> Callable[[Report], None]:
    """Tell the worker of progress: of a new stage or view at once, else now and then."""
    told: tuple[str, int | None] | None = None
    due = 0.0

    def observe(report: Report) -> None:
        nonlocal told, due
        now, news = time.monotonic(), (report.stage, report.view)
        if now >= due or news != told:
            told, due = news, now + TOLD_EVERY_S
            _send(connection, _progress(report))

    return observe


def _progress(report: Report) -> ProgressMessage:
    return ProgressMessage(
        stage=report.stage, progress=report.progress, energies=report.energies, view=report.view
    )


def _send(connection: Connection, message: Message) -> None:
    connection.send_bytes(MESSAGES.dump_json(message))


def _configure_logging(setup: ChildSetup) -> None:
    configure_logging(
        setup.log_level, setup.log_format, withhold_messages=setup.log_level != "DEBUG"
    )
    # A crash in a decoder leaves the places it passed through, and nothing of what it read.
    faulthandler.enable()


def _follow_worker(connection: Connection) -> SimpleQueue[GivenTask]:
    """Take jobs from the pipe as they come, and end with the worker at any moment."""
    jobs: SimpleQueue[GivenTask] = SimpleQueue()

    def follow() -> None:
        try:
            while True:
                jobs.put(take(connection))
        finally:
            os._exit(1)

    threading.Thread(target=follow, name="lifeline", daemon=True).start()
    return jobs


def _limit(memory_mb: int) -> None:
    # An interrupt from the terminal reaches the whole group; only the worker is to act on it.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    os.nice(NICENESS)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    limit = memory_mb * 1024 * 1024
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
    score = Path("/proc/self/oom_score_adj")
    if score.exists():
        score.write_text(str(OOM_SCORE))
