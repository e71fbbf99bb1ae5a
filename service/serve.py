"""``maquette serve``: the API in this process, a worker beside it, restarted when it dies."""

import logging
import os
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from typing import Final

import uvicorn

from service.api.app import create_app
from service.blobs import BlobStore
from service.engine.database import open_database, prepare_database
from service.engine.dbos_jobs import DbosJobEngine
from service.settings import Settings

LOG: Final = logging.getLogger(__name__)

WORKER_COMMAND: Final = (sys.executable, "-m", "service.worker")
RESTART_PAUSE_S: Final = 1.0
STOP_MARGIN_S: Final = 5.0
"""What a worker gets beyond its drain time before it is killed."""


class SupervisedWorker:
    """A worker process that is started again whenever it ends unasked.

    It holds the reading end of a pipe of ours as its standard input: should this process be
    killed, the pipe ends and the worker stops by itself.
    """

    def __init__(
        self, command: Sequence[str], *, environment: Mapping[str, str], stop_timeout_s: float
    ) -> None:
        self._command = list(command)
        self._environment = dict(environment)
        self._stop_timeout_s = stop_timeout_s
        self._stopping = threading.Event()
        self._lock = threading.Lock()
        self._process = self._spawn()
        self._thread = threading.Thread(target=self._watch, name="supervisor", daemon=True)
        self._thread.start()

    def stop(self) -> None:
        """Ask the worker to drain and wait for it; kill it if it does not end."""
        with self._lock:
            self._stopping.set()
            process = self._process
        if process.stdin is not None:
            process.stdin.close()
        try:
            process.wait(self._stop_timeout_s)
        except subprocess.TimeoutExpired:
            LOG.warning("The worker did not stop in time and is killed.")
            process.kill()
        self._thread.join()

    def _spawn(self) -> subprocess.Popen[bytes]:
        # A session of its own: an interrupt from the terminal is for us, we pass it on in order.
        return subprocess.Popen(
            self._command, stdin=subprocess.PIPE, env=self._environment, start_new_session=True
        )

    def _watch(self) -> None:
        while True:
            code = self._process.wait()
            if self._stopping.is_set():
                return
            LOG.error("The worker ended with code %d; starting another.", code)
            self._stopping.wait(RESTART_PAUSE_S)
            with self._lock:
                if self._stopping.is_set():
                    return
                self._process = self._spawn()


def listen(settings: Settings) -> socket.socket:
    """Bind the API's address; port 0 takes a free one."""
    family = socket.AF_INET6 if ":" in settings.host else socket.AF_INET
    listener = socket.socket(family, socket.SOCK_STREAM)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    listener.bind((settings.host, settings.port))
    return listener


def serve(
    settings: Settings,
    listener: socket.socket,
    *,
    worker_command: Sequence[str] | None = WORKER_COMMAND,
    announce: Callable[[str], None] = LOG.info,
) -> None:
    """Serve until interrupted; without a ``worker_command`` the workers run elsewhere.

    Uvicorn is told to stop by SIGINT or SIGTERM and lets open requests end first.
    """
    # Uvicorn takes the signals while it runs and raises them again when it is done: with the
    # handlers Python begins with, that would end the process before the worker is stopped.
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, _stop_before_serving)
    prepare_database(settings.system_database_url)
    worker = None
    if worker_command is not None:
        worker = SupervisedWorker(
            worker_command,
            environment=os.environ | settings.environment(),
            stop_timeout_s=settings.drain_s + STOP_MARGIN_S,
        )
    engine = DbosJobEngine(
        open_database(settings.system_database_url),
        max_queued=settings.max_queued,
        dead_after_s=settings.dead_after_s,
    )
    app = create_app(settings=settings, engine=engine, blobs=BlobStore(settings.blob_dir))
    server = uvicorn.Server(
        uvicorn.Config(
            app,
            log_config=None,
            log_level=settings.log_level.lower(),
            # Paths hold job ids; what happens to a job is logged where it happens.
            access_log=False,
            timeout_graceful_shutdown=5,
            server_header=False,
        )
    )
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, signal.SIG_IGN)
    host, port = listener.getsockname()[:2]
    announce(f"Maquette listens on http://{host}:{port}, documented at /docs.")
    try:
        server.run(sockets=[listener])
    finally:
        if worker is not None:
            worker.stop()
        engine.close()


def _stop_before_serving(_number: int, _frame: object) -> None:
    sys.exit(0)
