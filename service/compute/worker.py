"""The worker's composition root: settings in, a process that works until it is told to stop."""

import logging
import os
import queue
import shutil
import signal
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Final, NoReturn

from api_schemas.service import BodyModels
from service.compute.fork_server import ForkServer
from service.compute.kernels import settle_folders
from service.compute.lanes import QuickLane, answer_questions
from service.compute.models import check_detector, check_models, read_models
from service.compute.tasks import child_setup
from service.jobs.storage_identity import open_blob_store
from service.process.confinement import warn_of_weakness
from service.process.data_folder import prepare_data_folder
from service.process.supervisor import SAFE_PATH_VARIABLE
from service.settings import Settings

LOG: Final = logging.getLogger(__name__)

PIPELINE: Final = "service.compute.pipeline"
ESTIMATES: Final = "service.compute.answers"
PRELOAD: Final = "service.compute.preload"

NICENESS: Final = 5
"""Fits give way to the API on the same machine."""

SPARE_CONNECTIONS: Final = 6
"""To the database, beside one a fit: heartbeat, queue, notifications, and DBOS's own writes."""

THREAD_LIMITS: Final = (
    "OMP_NUM_THREADS",
    "OPENBLAS_NUM_THREADS",
    "MKL_NUM_THREADS",
    "NUMBA_NUM_THREADS",
    "OPENCV_FOR_THREADS_NUM",
)
"""One thread a fit, fits side by side: threads within a fit cost more than they bring."""

NOTICED_WITHIN_S: Final = 0.5
"""Delay of a stop that was requested in the moment a wait began, at most."""


def run_worker(
    settings: Settings,
    *,
    questions_at: str | None = None,
    pipeline: str = PIPELINE,
    estimates: str = ESTIMATES,
    preload: str = PRELOAD,
    read_models: Callable[[Settings], BodyModels] = read_models,
) -> None:
    """Work until SIGTERM or SIGINT.

    Beside an API it also answers the API's questions at the address ``questions_at``, and ends with
    standard input. ``pipeline`` and ``estimates`` are the tables of jobs and of questions,
    ``preload`` the module that the fork server imports.
    """
    stop, work = _begin(with_starter=questions_at is not None)
    prepare_data_folder(settings)
    check_detector(settings)
    blobs = open_blob_store(settings)
    # Loading takes longest and begins first, even if the database then turns out to be of no use.
    if questions_at is None:
        server = ForkServer(preload)
        server.begin_preloading()
    else:
        server = _answering(settings, questions_at, estimates, preload)
    setup = child_setup(settings, name="job", tasks=pipeline, niceness=NICENESS)
    # Imported here: estimators have no database, and this loads all of it.
    from service.compute.runner import JobRunner
    from service.jobs.database import open_database, prepare_database
    from service.jobs.storage_identity import take_storage
    from service.jobs.worker import WorkerEngine

    prepare_database(settings.system_database_url)
    take_storage(settings, blobs)
    runner = JobRunner(settings, blobs, server, setup)
    engine = WorkerEngine(
        open_database(
            settings.system_database_url,
            connections=settings.worker_processes + SPARE_CONNECTIONS,
        ),
        blobs,
        settings,
        is_able=server.is_able,
    )
    engine.start(runner.run, body_models=read_models(settings))
    LOG.info("Worker %s is ready.", engine.executor_id)
    warn_of_weakness()
    if not server.is_able():
        LOG.info("Jobs wait until the numerics are loaded, or compiled if that is not done yet.")
    stop.wait()
    LOG.info("Worker %s is stopping.", engine.executor_id)
    engine.stop(drain_s=settings.drain_s)
    _end(work)


def run_estimators(
    settings: Settings,
    *,
    questions_at: str,
    estimates: str = ESTIMATES,
    preload: str = PRELOAD,
) -> None:
    """Answer the questions of an API without a worker, as that would, until its end or SIGTERM.

    Raises
    ------
    SettingError
        If body models or detector cannot be used.
    """
    stop, work = _begin(with_starter=True)
    check_models(settings)
    check_detector(settings)
    _answering(settings, questions_at, estimates, preload)
    warn_of_weakness()
    stop.wait()
    _end(work)


class StopRequest:
    """A request to stop, which a signal may bring at any moment; the main thread waits for it.

    ``threading.Event`` will not do: for a moment in ``wait`` the main thread holds its lock, and a
    handler that sets the event then would wait for that lock for ever. Putting to a ``SimpleQueue``
    is safe in a handler.

    A signal that arrives after Python's last look for signals and before the wait sleeps does not
    wake it, and its handler runs when the wait ends: so a wait ends now and then, and begins anew.
    """

    def __init__(self) -> None:
        self._asked: queue.SimpleQueue[None] = queue.SimpleQueue()

    def ask(self) -> None:
        """Request the stop; may be called repeatedly."""
        self._asked.put(None)

    def wait(self) -> None:
        """Return once a stop has been requested."""
        while True:
            try:
                return self._asked.get(timeout=NOTICED_WITHIN_S)
            except queue.Empty:
                continue


def _begin(*, with_starter: bool) -> tuple[StopRequest, Path]:
    """Take requests to stop from here on; return them and the work folder."""
    stop = StopRequest()
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda _number, _frame: stop.ask())
    if with_starter:
        threading.Thread(target=_follow_starter, args=(stop,), name="starter", daemon=True).start()
    return stop, _settle_environment()


def _settle_environment() -> Path:
    """Settle the environment that the server inherits; return the work folder."""
    for variable in THREAD_LIMITS:
        os.environ.setdefault(variable, "1")
    # The fork server and its resource tracker are started by `python -c`.
    os.environ[SAFE_PATH_VARIABLE] = "1"
    return settle_folders()


def _follow_starter(stop: StopRequest) -> None:
    """Stop at the end of standard input: whoever started this process has ended, or wants it."""
    # Not through sys.stdin: a reader that holds its lock keeps the interpreter from ending.
    while os.read(sys.stdin.fileno(), 4_096):
        pass
    stop.ask()


def _answering(settings: Settings, questions_at: str, estimates: str, preload: str) -> ForkServer:
    """Start the fork server, and answer questions by what it forks."""
    server = ForkServer(preload, estimates)
    server.begin_preloading()
    setup = child_setup(settings, name="estimator", tasks=estimates)
    answer_questions(QuickLane(server, setup, children=settings.estimator_processes), questions_at)
    return server


def _end(work: Path) -> NoReturn:
    logging.shutdown()
    shutil.rmtree(work, ignore_errors=True)
    # Not a return: threads of fits that were handed back may still be there.
    os._exit(0)
