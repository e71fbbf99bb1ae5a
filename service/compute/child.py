"""Inside a child process: the only place where a caller's picture is decoded.

It does one task after the other, as many as it is given. Input and results go through the pipe to
its owner, so it needs neither database nor storage. It dies with its owner: a thread reads the
pipe, on which there is nothing but the next task, and the end of the pipe is the end of the owner
(a signal on the parent's death does not serve, the parent being the fork server).
"""

import contextlib
import faulthandler
import logging
import os
import resource
import signal
import tempfile
import threading
from multiprocessing.connection import Connection
from pathlib import Path
from queue import SimpleQueue
from typing import Final

from service.compute.messages import (
    DoneMessage,
    FaultMessage,
    Message,
    ProblemMessage,
    ProgressMessage,
    Received,
    TaskMessage,
    receive,
    send,
)
from service.compute.tasks import ChildSetup, Observe, Parts, ProblemError, load_tasks
from service.process.confinement import confine
from service.process.logs import configure_logging, log_context

LOG: Final = logging.getLogger(__name__)

OOM_SCORE: Final = 500
"""When memory runs out, the kernel is to take a child and not its owner."""


def work(setup: ChildSetup, connection: Connection) -> None:
    """Do the tasks that come, and tell the owner of each how it went."""
    _call_process(setup.name)
    configure_logging(
        setup.log_level, setup.log_format, withhold_messages=setup.log_level != "DEBUG"
    )
    # A crash in a decoder leaves the places it passed through, and nothing of what it read.
    faulthandler.enable()
    _limit(setup)
    _confine(setup)
    given = _follow_owner(connection)
    while True:
        # Nothing here holds a task on to the next: it goes out of scope with the call.
        _work_on(given.get(), setup, connection)


def _work_on(given: Received, setup: ChildSetup, connection: Connection) -> None:
    assert isinstance(given.message, TaskMessage)
    with log_context(**given.message.log_context):
        message, parts = _done(
            given.message.task,
            given.parts,
            setup,
            lambda report: send(connection, ProgressMessage(report=report)),
        )
        send(connection, message, parts.values())


def _done(task: str, given: Parts, setup: ChildSetup, observe: Observe) -> tuple[Message, Parts]:
    nothing: Parts = {}
    try:
        parts = load_tasks(setup.tasks)[task](setup, given, observe)
        return DoneMessage(parts=tuple(parts)), parts
    except ProblemError as error:
        return ProblemMessage(problem=error.problem), nothing
    except MemoryError:
        return FaultMessage(out_of_memory=True), nothing
    except Exception:
        LOG.exception("The task %s failed.", task)
        return FaultMessage(), nothing


def _follow_owner(connection: Connection) -> SimpleQueue[Received]:
    """Take tasks from the pipe as they come, and end with the owner at any moment."""
    tasks: SimpleQueue[Received] = SimpleQueue()

    def follow() -> None:
        try:
            while True:
                tasks.put(receive(connection))
        finally:
            os._exit(1)

    threading.Thread(target=follow, name="lifeline", daemon=True).start()
    return tasks


def _limit(setup: ChildSetup) -> None:
    # An interrupt from the terminal reaches the whole group; only the owner is to act on it.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    os.nice(setup.niceness)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    limit = setup.memory_mb * 1024 * 1024
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
    score = Path("/proc/self/oom_score_adj")
    if score.exists():
        score.write_text(str(OOM_SCORE))


def _confine(setup: ChildSetup) -> None:
    """Give up what no task needs; temporary files lie in a folder of its own from here on."""
    own = Path(tempfile.gettempdir(), str(os.getpid()))
    own.mkdir(mode=0o700, exist_ok=True)
    os.environ["TMPDIR"] = tempfile.tempdir = str(own)
    kernels = os.environ.get("NUMBA_CACHE_DIR")
    confine(readable=[*setup.readable, *([kernels] if kernels else [])], writable=str(own))


def _call_process(name: str) -> None:
    """Name this process, in at most 15 letters; its command, which is listed, is another's.

    Where there is no ``/proc`` it keeps its name.
    """
    with contextlib.suppress(OSError):
        Path("/proc/self/comm").write_text(name)
