"""``maquette serve``: the API in this process, a worker or estimators alone in another."""

import errno
import logging
import os
import signal
import socket
import sys
from collections.abc import Callable, Mapping, Sequence
from typing import Final

from service.commands.prepare import run_preflight
from service.numerics.quick_lane import SOCKET, asking
from service.process.supervisor import PYTHON, SupervisedProcess
from service.process.work_folder import make_work_folder
from service.settings import PREFIX, SettingError, Settings
from service.startup import UNUSABLE_SETTINGS

LOG: Final = logging.getLogger(__name__)

WORKER_COMMAND: Final = (*PYTHON, "-m", "service.compute")
ESTIMATORS_COMMAND: Final = (*PYTHON, "-m", "service.estimates")
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
    estimators_command: Sequence[str] = ESTIMATORS_COMMAND,
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
    blobs = run_preflight(settings)
    environment = _environment(settings)
    # Of this process alone: what children of the worker may write to is the worker's.
    address = str(make_work_folder() / SOCKET)
    if worker_command is not None:
        beside = _start_worker(settings, [*worker_command, address], environment)
    else:
        beside = _start_estimators(settings, [*estimators_command, address], environment)
    from service.commands.api_process import assemble

    process = assemble(settings, blobs, asking(address))
    # The server handles signals while it runs, and raises them again when it is done: they must
    # not end this process before the worker is stopped.
    _on_signals(process.ask_to_stop)
    host, port = listener.getsockname()[:2]
    announce(f"Maquette listens on http://{host}:{port}, documented at /docs.")
    try:
        process.run(listener)
    finally:
        beside.stop()
        process.close()
    return _status(beside)


def _on_signals(act: Callable[[], object]) -> None:
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda _number, _frame: act())


def _start_worker(
    settings: Settings, command: Sequence[str], environment: Mapping[str, str]
) -> SupervisedProcess:
    return SupervisedProcess(
        command,
        name="worker",
        environment=environment,
        stop_timeout_s=settings.drain_s + STOP_MARGIN_S,
        final_code=UNUSABLE_SETTINGS,
        # As if we had been told to stop.
        on_final_end=lambda: os.kill(os.getpid(), signal.SIGTERM),
    )


def _start_estimators(
    settings: Settings, command: Sequence[str], environment: Mapping[str, str]
) -> SupervisedProcess:
    return SupervisedProcess(
        command,
        name="estimators",
        environment=environment,
        stop_timeout_s=settings.drain_s + STOP_MARGIN_S,
    )


def _status(beside: SupervisedProcess | None) -> int:
    return UNUSABLE_SETTINGS if beside is not None and beside.has_finally_ended else 0


def _environment(settings: Settings) -> dict[str, str]:
    """The environment of processes started from here: our settings, without misspelt ones."""
    others = {
        name: value for name, value in os.environ.items() if not name.upper().startswith(PREFIX)
    }
    return others | settings.environment()
