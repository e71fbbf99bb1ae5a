"""The worker's composition root: settings in, a process that works until it is told to stop."""

import logging
import os
import shutil
import signal
from collections.abc import Sequence
from typing import Final

from service.blobs import open_blob_store, setting_of_storage
from service.process.caches import settle_folders
from service.process.data_folder import prepare_data_folder
from service.process.disk import open_disk
from service.process.heap import KEPT
from service.process.interpreter import SAFE_PATH_VARIABLE
from service.process.stop_request import StopRequest
from service.settings import Settings
from service.worker.child_process import ChildRunner
from service.worker.fork_requests import follow_starter
from service.worker.fork_server import ForkedProcesses
from service.worker.model_files import check_detector
from service.worker.models_reading import COMMAND as MODELS_COMMAND
from service.worker.models_reading import ModelsBeingRead

LOG: Final = logging.getLogger(__name__)

PIPELINE: Final = "service.worker.pipeline"
SANDBOX_PIPELINE: Final = "service.worker.sandbox"
SECRETLESS: Final = "service.worker.secretless"
PRELOAD: Final = "service.worker.preload"
ESTIMATOR: Final = "service.estimates.forked_estimator"

THREAD_LIMITS: Final = (
    "OMP_NUM_THREADS",
    "OPENBLAS_NUM_THREADS",
    "MKL_NUM_THREADS",
    "NUMBA_NUM_THREADS",
    "OPENCV_FOR_THREADS_NUM",
)
"""One thread a fit, fits side by side: threads within a fit cost more than they bring."""

SPARE_CONNECTIONS: Final = 6
"""To the database, beside one a fit: heartbeat, queue, notifications, and DBOS's own writes."""


def run_worker(
    settings: Settings,
    *,
    follow_stdin: bool,
    pipeline: str | None = None,
    secretless: str = SECRETLESS,
    preload: str = PRELOAD,
    estimator: str = ESTIMATOR,
    models_command: Sequence[str] = MODELS_COMMAND,
) -> None:
    """Work until SIGTERM or SIGINT, or until standard input ends if that is to be followed.

    ``pipeline`` is by default the real one, or the sandbox's where that is set.
    ``secretless`` is what its fork server imports first, ``preload`` what last.
    ``estimator`` is what runs in processes forked for whoever started this one.
    ``models_command`` starts the process that says which body models there are.
    """
    if pipeline is None:
        pipeline = SANDBOX_PIPELINE if settings.sandbox else PIPELINE
    stop = StopRequest()
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda _number, _frame: stop.ask())
    for variable in THREAD_LIMITS:
        os.environ.setdefault(variable, "1")
    for variable, value in KEPT.items():
        os.environ.setdefault(variable, value)
    # The fork server and its resource tracker are started by `python -c`.
    os.environ[SAFE_PATH_VARIABLE] = "1"
    work = settle_folders()
    prepare_data_folder(settings)
    check_detector(settings)
    blobs = open_blob_store(settings)
    processes = ForkedProcesses(secretless, *((estimator,) if follow_stdin else ()), preload)
    if follow_stdin:
        follow_starter(processes, module=estimator, ended=stop.ask)
    runner = ChildRunner(settings, blobs, processes, pipeline=pipeline)
    # What takes longest begins first, even if the database then turns out to be of no use.
    processes.begin_preloading()
    models = ModelsBeingRead(settings, command=models_command)
    # Imported while others load the numerics and read the models: a good part of a second each.
    from service.engine.database import open_database, prepare_database
    from service.engine.storage_identity import take_storage

    prepare_database(settings.system_database_url, sandbox=settings.sandbox)
    take_storage(settings.system_database_url, blobs, named=setting_of_storage(settings))
    from service.engine.dbos_worker import DbosWorkerEngine
    from service.process.tracing import start_tracing

    tracing = start_tracing(settings, role="worker")
    engine = DbosWorkerEngine(
        open_database(
            settings.system_database_url,
            connections=settings.worker_processes + SPARE_CONNECTIONS,
        ),
        blobs,
        processes=settings.worker_processes,
        max_crashes=settings.max_crashes,
        heartbeat_s=settings.heartbeat_s,
        dead_after_s=settings.dead_after_s,
        queue_poll_s=settings.queue_poll_s,
        retention_s=settings.retention_s,
        disk=open_disk(settings),
        is_able=processes.is_able,
    )
    engine.start(runner.run, body_models=models.wait())
    LOG.info("Worker %s is ready.", engine.executor_id)
    if settings.sandbox:
        LOG.warning("This worker is a sandbox: its results are canned, whatever was sent.")
    if not processes.is_able():
        LOG.info("Jobs wait until the numerics are loaded, or compiled if that is not done yet.")
    stop.wait()
    LOG.info("Worker %s is stopping.", engine.executor_id)
    engine.stop(drain_s=settings.drain_s)
    tracing.stop()
    logging.shutdown()
    shutil.rmtree(work, ignore_errors=True)
    # Not a return: threads of fits that were handed back may still be there.
    os._exit(0)
