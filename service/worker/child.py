"""Inside the child process: the only place where a caller's picture is decoded.

One process a job. Input and files of the result go through the pipe to its worker, so it needs
neither database nor storage. It dies with its worker: once it has its input, a thread reads the
pipe, on which the worker says nothing more, and the end of the pipe is the end of the worker (a
signal on the parent's death does not serve, the parent being the fork server).
"""

import faulthandler
import logging
import os
import resource
import signal
import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Final
from uuid import UUID

from api_schemas.derivation_kinds import AnyDerivationOptions
from api_schemas.derivations import DerivationRequest
from api_schemas.problems import Problem, field_problem, problem
from api_schemas.requests import FitOptions
from api_schemas.scans import ScanOptions
from service.engine.port import FIT, SCAN, Report
from service.jobs.inputs import IMAGE, MASK, SANDBOX, image_of, mask_of, own_and_others
from service.process.logs import LogContext, configure_logging, log_context
from service.process.naming import call_process
from service.worker.artifacts import with_result_document
from service.worker.messages import (
    MESSAGES,
    DoneMessage,
    FileMessage,
    Message,
    ProblemMessage,
    ProgressMessage,
)
from service.worker.pipeline_port import (
    DerivationInput,
    PipelineInput,
    ProblemError,
    ScanInput,
    ScanPicture,
    UnusableInputError,
    load_pipeline,
)

LOG: Final = logging.getLogger(__name__)

NICENESS: Final = 5
"""Fits give way to the API on the same machine."""

OOM_SCORE: Final = 500
"""When memory runs out, the kernel is to take the fit and not the worker."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ChildTask:
    """What the worker tells the child to begin with; options and named inputs follow as bytes.

    ``fit_id`` is that of the fit a job derives from, None for a fit.
    """

    pipeline: str
    kind: str
    inputs: tuple[str, ...]
    max_pixels: int
    models: Path | None
    detector: Path | None
    memory_mb: int
    log_level: str
    log_format: str
    log_context: LogContext
    fit_id: str | None = None


def work(task: ChildTask, connection: Connection) -> None:
    """Run one job and tell the worker how it went."""
    call_process("job")
    _configure_logging(task)
    _limit(task.memory_mb)
    try:
        options = connection.recv_bytes()
        inputs = {name: connection.recv_bytes() for name in task.inputs}
    except EOFError:
        os._exit(1)
    _follow_worker(connection)
    with log_context(**task.log_context):
        _answer(connection, lambda: _work(task, options, inputs, connection))


def _work(
    task: ChildTask, options: bytes, inputs: Mapping[str, bytes], connection: Connection
) -> Message:
    pipeline = load_pipeline(task.pipeline)

    def observe(report: Report) -> None:
        _send(connection, _progress(report))

    if task.kind == SCAN:
        scanned = pipeline.scan(_scan_input(task, options, inputs), observe)
        files = with_result_document(scanned.result, scanned.artifacts)
        stage_seconds = {}
    elif task.kind == FIT:
        fitted = pipeline.run(_fit_input(task, options, inputs), observe)
        files = with_result_document(fitted.result, fitted.artifacts)
        stage_seconds = fitted.result.stage_seconds
    else:
        derived = pipeline.derive(_derivation_input(task, options, inputs), observe)
        files = with_result_document(derived.result, derived.artifacts)
        stage_seconds = {}
    for name, content in files.items():
        _send(connection, FileMessage(name=name))
        connection.send_bytes(content)
    return DoneMessage(stage_seconds=stage_seconds)


def _fit_input(task: ChildTask, options: bytes, inputs: Mapping[str, bytes]) -> PipelineInput:
    return PipelineInput(
        options=FitOptions.model_validate_json(options),
        image=inputs[IMAGE],
        mask=inputs.get(MASK),
        max_pixels=task.max_pixels,
        models=task.models,
        detector=task.detector,
        ending=_ending(inputs),
    )


def _scan_input(task: ChildTask, options: bytes, inputs: Mapping[str, bytes]) -> ScanInput:
    asked = ScanOptions.model_validate_json(options)
    return ScanInput(
        options=asked,
        pictures=tuple(
            ScanPicture(image=inputs[image_of(number)], mask=inputs.get(mask_of(number)))
            for number in range(len(asked.views))
        ),
        max_pixels=task.max_pixels,
        models=task.models,
        detector=task.detector,
        ending=_ending(inputs),
    )


def _derivation_input(
    task: ChildTask, options: bytes, inputs: Mapping[str, bytes]
) -> DerivationInput[AnyDerivationOptions]:
    own, others = own_and_others(inputs)
    return DerivationInput(
        options=DerivationRequest.model_validate_json(options).root,
        inputs=own,
        others=others,
        max_pixels=task.max_pixels,
        models=task.models,
        detector=task.detector,
        fit_id=None if task.fit_id is None else UUID(task.fit_id),
        ending=_ending(inputs),
    )


def _ending(inputs: Mapping[str, bytes]) -> str | None:
    return inputs[SANDBOX].decode() if SANDBOX in inputs else None


def _answer(connection: Connection, work: Callable[[], Message]) -> None:
    try:
        message = work()
    except ProblemError as error:
        message = ProblemMessage(problem=error.problem)
    except UnusableInputError as error:
        message = ProblemMessage(problem=field_problem("unusable-input", error.error))
    except MemoryError:
        message = ProblemMessage(problem=_out_of_memory())
    except Exception:
        LOG.exception("The job failed.")
        message = ProblemMessage(problem=_fault())
    _send(connection, message)


def _progress(report: Report) -> ProgressMessage:
    return ProgressMessage(
        stage=report.stage, progress=report.progress, energies=report.energies, view=report.view
    )


def _send(connection: Connection, message: Message) -> None:
    connection.send_bytes(MESSAGES.dump_json(message))


def _fault() -> Problem:
    return problem(
        "fit-failed",
        detail="An unexpected fault ended the job.",
        remedy="Report it with the job's id; other jobs are not affected.",
    )


def _out_of_memory() -> Problem:
    return problem(
        "fit-failed",
        code="out-of-memory",
        detail="The job needed more memory than one job may have.",
        remedy="Send a smaller picture, or ask for less at once.",
    )


def _configure_logging(task: ChildTask) -> None:
    configure_logging(task.log_level, task.log_format, withhold_messages=task.log_level != "DEBUG")
    # A crash in a decoder leaves the places it passed through, and nothing of what it read.
    faulthandler.enable()


def _follow_worker(connection: Connection) -> None:
    def wait_for_the_end() -> None:
        try:
            connection.recv_bytes()
        except (EOFError, OSError):
            os._exit(1)

    threading.Thread(target=wait_for_the_end, name="lifeline", daemon=True).start()


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
