"""``maquette serve``: the API in this process, a worker or estimators alone in another."""

import argparse
import logging
import os
import signal
import sys
import threading
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Final

from service.compute.lanes import SOCKET, asking
from service.compute.models import check_detector, check_models
from service.jobs.blobs import BlobStore
from service.jobs.database import open_database, prepare_database
from service.jobs.storage_identity import open_blob_store, take_storage
from service.process.data_folder import open_disk, prepare_data_folder
from service.process.listener import Listener, listen
from service.process.supervisor import PYTHON, SupervisedProcess
from service.process.work_folder import make_work_folder
from service.settings import PREFIX, Settings
from service.startup import UNUSABLE, UNUSABLE_SETTINGS, given, run_service

LOG: Final = logging.getLogger(__name__)

WORKER_COMMAND: Final = (*PYTHON, "-m", "service.compute")
ESTIMATORS_COMMAND: Final = (*PYTHON, "-m", "service.compute", "questions")
STOP_MARGIN_S: Final = 5.0
"""Time that a worker gets beyond its drain time before it is killed, seconds."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Some settings, and what is not one."""
    parser.add_argument("--host", help="address to listen on (default: the setting, 127.0.0.1)")
    parser.add_argument("--port", type=int, help="port, 0 for a free one (default: 8000)")
    parser.add_argument("--data-dir", type=Path, help="folder of database, pictures and results")
    parser.add_argument("--models-dir", type=Path, help="folder of female.npz and male.npz")
    parser.add_argument("--no-worker", action="store_true", help="the workers run elsewhere")
    parser.add_argument(
        "--adopt-storage",
        action="store_true",
        help="let this folder or bucket take the place of the one that the database had",
    )


def run(parsed: argparse.Namespace) -> int:
    """Serve as the command line says."""
    options = given(parsed, "host", "port", "data_dir", "models_dir")
    worker_command = None if parsed.no_worker else WORKER_COMMAND

    def work(settings: Settings) -> int:
        try:
            listener = listen(settings)
        except OSError as error:
            print(
                f"maquette serve: cannot listen on {settings.host}:{settings.port} "
                f"({error.strerror}). Stop what listens there, or choose another port with --port.",
                file=sys.stderr,
            )
            return UNUSABLE
        return serve(
            settings,
            listener,
            worker_command=worker_command,
            adopt_storage=parsed.adopt_storage,
            announce=lambda text: print(text, flush=True),
        )

    return run_service("serve", work, options)


def serve(
    settings: Settings,
    listener: Listener,
    *,
    worker_command: Sequence[str] | None = WORKER_COMMAND,
    estimators_command: Sequence[str] = ESTIMATORS_COMMAND,
    adopt_storage: bool = False,
    announce: Callable[[str], None] = LOG.info,
) -> int:
    """Serve until interrupted; without a ``worker_command`` the workers run elsewhere.

    Then only estimators are started beside the API. Either is told the address at which the API's
    questions are to be answered. Uvicorn is told to stop by SIGINT or SIGTERM and lets open
    requests end first. Returns the exit status: that of unusable settings if the worker found them
    to be so.
    """
    beside: SupervisedProcess | None = None
    _on_signals(lambda: sys.exit(_status(beside)))
    # All faults of the settings come to light before anything with the same settings is started.
    blobs = preflight(settings, adopt_storage=adopt_storage)
    # Of this process alone: what children of the worker may write to is the worker's.
    address = str(make_work_folder() / SOCKET)
    beside = SupervisedProcess(
        [*(worker_command or estimators_command), address],
        name="worker" if worker_command else "estimators",
        environment=_environment(settings),
        stop_timeout_s=settings.drain_s + STOP_MARGIN_S,
        final_code=UNUSABLE_SETTINGS if worker_command else None,
        # As if we had been told to stop.
        on_final_end=lambda: os.kill(os.getpid(), signal.SIGTERM),
    )
    # Imported while the worker starts: it takes a second.
    from service.api.app import ApiServer, create_app
    from service.api.fits import represent
    from service.compute.lanes import header_lane
    from service.jobs.engine import JobEngine
    from service.jobs.keys import KeyRing
    from service.jobs.notices import send_notice, start_notices, stop_notices

    database = open_database(settings.system_database_url)
    engine = JobEngine(database, blobs, settings)
    send = partial(send_notice, blobs=blobs, represent=represent, settings=settings)
    draining = threading.Event()
    app = create_app(
        settings=settings,
        engine=engine,
        blobs=blobs,
        disk=open_disk(settings),
        ask=asking(address),
        read_header_for=header_lane(settings),
        keys=KeyRing(database),
        draining=draining,
    )
    server = ApiServer(
        app,
        log_level=settings.log_level,
        draining=draining,
        stop_delay_s=settings.stop_delay_s,
    )
    # The server handles signals while it runs, and raises them again when it is done: they must
    # not end this process before the worker is stopped.
    _on_signals(lambda: setattr(server, "should_exit", True))
    # Whoever is told now and asks at once waits for the server, and is not turned away.
    listener.listen()
    host, port = listener.getsockname()[:2]
    announce(f"Maquette listens on http://{host}:{port}, documented at /docs.")
    try:
        engine.start()
        start_notices(database, send)
        server.run(sockets=[listener])
    finally:
        beside.stop()
        stop_notices()
        engine.close()
    return _status(beside)


def preflight(settings: Settings, *, adopt_storage: bool = False) -> BlobStore:
    """Check data folder, models and detector, prepare database and storage; return the last.

    Waits for a database or a storage that does not answer. With ``adopt_storage`` the storage takes
    the place of the one that the database had.

    Raises
    ------
    SettingError
        If folder, models or detector cannot be used.
    DatabaseUnusableError
        If the database cannot be used.
    StorageUnusableError
        If the storage cannot be used, or is that of another database.
    """
    prepare_data_folder(settings)
    check_models(settings)
    check_detector(settings)
    prepare_database(settings.system_database_url)
    blobs = open_blob_store(settings)
    take_storage(settings, blobs, adopt=adopt_storage)
    return blobs


def _on_signals(act: Callable[[], object]) -> None:
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda _number, _frame: act())


def _status(beside: SupervisedProcess | None) -> int:
    return UNUSABLE_SETTINGS if beside is not None and beside.has_finally_ended else 0


def _environment(settings: Settings) -> dict[str, str]:
    """The environment of processes started from here: our settings, without misspelt ones."""
    others = {
        name: value for name, value in os.environ.items() if not name.upper().startswith(PREFIX)
    }
    return others | settings.environment()
