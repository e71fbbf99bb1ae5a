"""Inside the child process: the only place where a caller's picture is decoded.

One process a fit. It dies with its worker: a thread reads the pipe to the worker, which never says
anything, and the end of the pipe is the end of the worker (a signal on the parent's death does not
serve, the parent being the fork server).
"""

import logging
import os
import resource
import signal
import threading
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Final

from api_schemas.problems import Problem, field_problem, problem
from api_schemas.requests import FitOptions
from service.blobs import BlobStore
from service.engine.port import Report
from service.worker.artifacts import describe_artifact, with_result_document
from service.worker.messages import (
    MESSAGES,
    DescriptionMessage,
    DoneMessage,
    Message,
    ProblemMessage,
    ProgressMessage,
)
from service.worker.pipeline_port import PipelineInput, UnusableInputError, load_pipeline

LOG: Final = logging.getLogger(__name__)

NICENESS: Final = 5
"""Fits give way to the API on the same machine."""

OOM_SCORE: Final = 500
"""When memory runs out, the kernel is to take the fit and not the worker."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ChildTask:
    """What the worker gives the child: names of blobs, and limits."""

    pipeline: str
    blob_root: str
    scope: str
    options: str
    image: str
    mask: str | None
    max_pixels: int
    memory_mb: int


def fit(task: ChildTask, connection: Connection) -> None:
    """Run one fit and tell the worker how it went."""
    _follow_worker(connection)
    _limit(task.memory_mb)
    _answer(connection, lambda: _fit(task, connection))


def describe(pipeline: str, connection: Connection) -> None:
    """Tell the worker which body models there are."""
    _follow_worker(connection)
    _send(connection, DescriptionMessage(body_models=load_pipeline(pipeline).describe()))


def _fit(task: ChildTask, connection: Connection) -> Message:
    blobs = BlobStore(Path(task.blob_root))
    output = load_pipeline(task.pipeline).run(
        PipelineInput(
            options=FitOptions.model_validate_json(task.options),
            image=blobs.get(task.scope, task.image),
            mask=None if task.mask is None else blobs.get(task.scope, task.mask),
            max_pixels=task.max_pixels,
        ),
        lambda report: _send(connection, _progress(report)),
    )
    files = with_result_document(output.result, output.artifacts)
    for content in files.values():
        blobs.put(task.scope, content)
    return DoneMessage(
        artifacts=tuple(describe_artifact(name, content) for name, content in files.items())
    )


def _answer(connection: Connection, work: Callable[[], Message]) -> None:
    try:
        message = work()
    except UnusableInputError as error:
        message = ProblemMessage(problem=field_problem("unusable-input", error.error))
    except MemoryError:
        message = ProblemMessage(problem=_out_of_memory())
    except FileNotFoundError:
        # The job was erased under the fit; nobody waits for an answer.
        LOG.info("The input of the fit is gone.")
        message = ProblemMessage(problem=_fault())
    except Exception:
        LOG.exception("The fit failed.")
        message = ProblemMessage(problem=_fault())
    _send(connection, message)


def _progress(report: Report) -> ProgressMessage:
    return ProgressMessage(stage=report.stage, progress=report.progress, energies=report.energies)


def _send(connection: Connection, message: Message) -> None:
    connection.send_bytes(MESSAGES.dump_json(message))


def _fault() -> Problem:
    return problem(
        "fit-failed",
        detail="An unexpected fault ended the fit.",
        remedy="Report it with the job's id; other pictures are not affected.",
    )


def _out_of_memory() -> Problem:
    return problem(
        "fit-failed",
        code="out-of-memory",
        detail="The fit needed more memory than one fit may have.",
        remedy="Send a smaller picture.",
    )


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
