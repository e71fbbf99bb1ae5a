"""``maquette serve``: the API in this process, a worker and estimators in others."""

import errno
import logging
import os
import signal
import socket
import sys
from collections.abc import Callable, Mapping, Sequence
from typing import Final

from service.commands.preflight import run_preflight
from service.engine.ballast import open_ballast
from service.estimates.starting import Start, by_command, by_passing_on, can_watch_processes
from service.process.interpreter import PYTHON
from service.process.supervisor import SupervisedWorker
from service.process.tracing import start_tracing
from service.settings import PREFIX, SettingError, Settings
from service.startup.begin import UNUSABLE_SETTINGS

LOG: Final = logging.getLogger(__name__)

WORKER_COMMAND: Final = (*PYTHON, "-m", "service.worker")
ESTIMATOR_COMMAND: Final = (*PYTHON, "-m", "service.estimates")
STOP_MARGIN_S: Final = 5.0
"""How much longer than its drain time a worker gets before it is killed."""


def listen(settings: Settings) -> socket.socket:
    """Bind the API's address; port 0 takes a free one.

    Raises
    ------
    OSError
        If something else is listening there.
    SettingError
        If it is impossible to listen on the address.
    """
    family = socket.AF_INET6 if ":" in settings.host else socket.AF_INET
    # With the protocol given explicitly, asyncio sends what is written at once: otherwise each
    # response on a kept-alive connection would wait 40 ms for the acknowledgement of its headers.
    listener = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((settings.host, settings.port))
    except OSError as error:
        listener.close()
        if error.errno == errno.EADDRINUSE:
            raise
        reason = (
            f"it cannot be listened on port {settings.port} there ({error.strerror}); name an "
            "address of this machine, and a port above 1023"
        )
        raise SettingError(reason, name="host", value=settings.host) from error
    return listener


def serve(
    settings: Settings,
    listener: socket.socket,
    *,
    worker_command: Sequence[str] | None = WORKER_COMMAND,
    estimator_command: Sequence[str] | None = None,
    announce: Callable[[str], None] = LOG.info,
) -> int:
    """Serve until interrupted; without a ``worker_command`` the workers run elsewhere.

    The worker forks the estimators, unless there is none or an ``estimator_command`` is given.
    Uvicorn is told to stop by SIGINT or SIGTERM and lets open requests end first. Returns the exit
    status: that of unusable settings if the worker found them to be so.
    """
    worker: SupervisedWorker | None = None
    _on_signals(lambda: sys.exit(_status(worker)))
    # All faults of the settings come to light before anything with the same settings is started.
    ballast = open_ballast(settings)
    ballast.make_room()
    blobs = run_preflight(settings)
    tracing = start_tracing(settings, role="api")
    environment = _environment(settings)
    if worker_command is not None:
        worker = _start_worker(settings, worker_command, environment)
    from service.commands.api_process import assemble

    process = assemble(
        settings, blobs, ballast, _estimator_start(worker, estimator_command, environment)
    )
    # The server handles signals while it runs, and raises them again when it is done: they must
    # not end this process before the worker is stopped.
    _on_signals(process.ask_to_stop)
    host, port = listener.getsockname()[:2]
    announce(f"Maquette listens on http://{host}:{port}, documented at /docs.")
    if settings.sandbox:
        LOG.warning("This is a sandbox: its results are canned, whatever is sent.")
    try:
        process.run(listener)
    finally:
        if worker is not None:
            worker.stop()
        process.close()
        tracing.stop()
    return _status(worker)


def _on_signals(act: Callable[[], object]) -> None:
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda _number, _frame: act())


def _start_worker(
    settings: Settings, command: Sequence[str], environment: Mapping[str, str]
) -> SupervisedWorker:
    return SupervisedWorker(
        command,
        environment=environment,
        stop_timeout_s=settings.drain_s + STOP_MARGIN_S,
        final_code=UNUSABLE_SETTINGS,
        # As if we had been told to stop.
        on_final_end=lambda: os.kill(os.getpid(), signal.SIGTERM),
    )


def _estimator_start(
    worker: SupervisedWorker | None,
    command: Sequence[str] | None,
    environment: Mapping[str, str],
) -> Start:
    if worker is not None and command is None and can_watch_processes():
        return by_passing_on(worker.pass_on)
    return by_command(command or ESTIMATOR_COMMAND, environment=environment)


def _status(worker: SupervisedWorker | None) -> int:
    return UNUSABLE_SETTINGS if worker is not None and worker.has_finally_ended else 0


def _environment(settings: Settings) -> dict[str, str]:
    """The environment of processes started from here: our settings, without misspelt ones."""
    others = {
        name: value for name, value in os.environ.items() if not name.upper().startswith(PREFIX)
    }
    return others | settings.environment()
