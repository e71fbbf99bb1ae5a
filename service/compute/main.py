"""The worker's composition root: settings in, a process that works until it is told to stop."""

import logging
import os
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Final, NoReturn

from service.compute.models_reading import COMMAND as MODELS_COMMAND
from service.compute.models_reading import ModelsBeingRead, check_detector, check_models
from service.jobs.blobs import open_blob_store, setting_of_storage
from service.numerics.fork_server import ForkServer, settle_environment
from service.numerics.quick_lane import QuickLane, answer_questions
from service.numerics.tasks import child_setup
from service.process.data_folder import open_disk, prepare_data_folder
from service.process.stop_request import StopRequest
from service.settings import Settings

LOG: Final = logging.getLogger(__name__)

PIPELINE: Final = "service.compute.pipeline"
SECRETLESS: Final = "service.compute.secretless"
PRELOAD: Final = "service.compute.preload"
ESTIMATES: Final = "service.estimates.answers"

NICENESS: Final = 5
"""Fits give way to the API on the same machine."""

SPARE_CONNECTIONS: Final = 6
"""To the database, beside one a fit: heartbeat, queue, notifications, and DBOS's own writes."""


def run_worker(
    settings: Settings,
    *,
    questions_at: str | None = None,
    pipeline: str = PIPELINE,
    estimates: str = ESTIMATES,
    secretless: str = SECRETLESS,
    preload: str = PRELOAD,
    models_command: Sequence[str] = MODELS_COMMAND,
) -> None:
    """Work until SIGTERM or SIGINT.

    Beside an API it also answers the API's questions at the address ``questions_at``, and ends with
    standard input. ``pipeline`` and ``estimates`` are the tables of jobs and of questions.
    ``secretless`` is what the fork server imports first, ``preload`` what next. ``models_command``
    starts the process that says which body models there are.
    """
    stop, work = _begin(with_starter=questions_at is not None)
    prepare_data_folder(settings)
    check_detector(settings)
    blobs = open_blob_store(settings)
    # What takes longest begins first, even if the database then turns out to be of no use.
    if questions_at is None:
        server = ForkServer(secretless, preload)
        server.begin_preloading()
    else:
        server = _answering(settings, questions_at, estimates, secretless, preload)
    setup = child_setup(settings, name="job", tasks=pipeline, niceness=NICENESS)
    models = ModelsBeingRead(settings, command=models_command)
    # Imported while others load the numerics and read the models: a good part of a second each.
    from service.compute.job_runner import JobRunner
    from service.jobs.database import open_database, prepare_database
    from service.jobs.storage_identity import take_storage

    prepare_database(settings.system_database_url)
    take_storage(settings.system_database_url, blobs, named=setting_of_storage(settings))
    from service.jobs.worker import WorkerEngine

    engine = WorkerEngine(
        open_database(
            settings.system_database_url,
            connections=settings.worker_processes + SPARE_CONNECTIONS,
        ),
        blobs,
        processes=settings.worker_processes,
        max_crashes=settings.max_crashes,
        heartbeat_s=settings.heartbeat_s,
        dead_after_s=settings.dead_after_s,
        retention_s=settings.retention_s,
        disk=open_disk(settings),
        is_able=server.is_able,
    )
    runner = JobRunner(settings, blobs, server, setup)
    engine.start(runner.run, body_models=models.wait())
    LOG.info("Worker %s is ready.", engine.executor_id)
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
    secretless: str = SECRETLESS,
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
    _answering(settings, questions_at, estimates, secretless, preload)
    stop.wait()
    _end(work)


def _begin(*, with_starter: bool) -> tuple[StopRequest, Path]:
    """Take requests to stop from here on; return them and the work folder."""
    stop = StopRequest()
    stop.on_signals()
    if with_starter:
        stop.with_starter()
    return stop, settle_environment()


def _answering(
    settings: Settings, questions_at: str, estimates: str, secretless: str, preload: str
) -> ForkServer:
    """Start the fork server, and answer questions by what it forks."""
    server = ForkServer(secretless, preload, estimates)
    server.begin_preloading()
    setup = child_setup(settings, name="estimator", tasks=estimates)
    answer_questions(QuickLane(server, setup, children=settings.estimator_processes), questions_at)
    return server


def _end(work: Path) -> NoReturn:
    logging.shutdown()
    shutil.rmtree(work, ignore_errors=True)
    # Not a return: threads of fits that were handed back may still be there.
    os._exit(0)
