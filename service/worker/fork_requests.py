"""What whoever started the worker tells it over its standard input: its end, and what to fork.

The API's estimators need the numerics that the fork server has loaded: forked from it they share
its memory, and take a fraction of a second to start. So the API passes the worker beside it a
connection, and an estimator is forked that answers over it. The worker sees no more of it: the
estimator ends when the API closes the connection, and lives on if worker and fork server die.
"""

import importlib
import logging
import os
import socket
import stat
import sys
import threading
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import Final, Protocol, cast

from service.worker.fork_server import ForkedProcesses, NoProcessError

LOG: Final = logging.getLogger(__name__)

READ_AT_ONCE: Final = 4_096
CONNECTIONS_AT_ONCE: Final = 16


class Answering(Protocol):
    """A module that is run in a process forked on request."""

    def answer(self, connection: Connection) -> None:
        """Answer over the connection until it ends."""
        ...


def follow_starter(processes: ForkedProcesses, *, module: str, ended: Callable[[], None]) -> None:
    """Follow standard input in a thread; ``module`` is what is run for each connection."""

    def follow() -> None:
        # Not through sys.stdin: a reader that holds its lock keeps the interpreter from ending.
        number = sys.stdin.fileno()
        if stat.S_ISSOCK(os.fstat(number).st_mode):
            _fork_what_is_asked(socket.socket(fileno=os.dup(number)), processes, module)
        else:
            while os.read(number, READ_AT_ONCE):
                pass
        ended()

    threading.Thread(target=follow, name="starter", daemon=True).start()


def _fork_what_is_asked(starter: socket.socket, processes: ForkedProcesses, module: str) -> None:
    while True:
        try:
            said, numbers, _, _ = socket.recv_fds(starter, READ_AT_ONCE, CONNECTIONS_AT_ONCE)
        except OSError:
            return
        for number in numbers:
            # In a thread: the fork server may be loading for minutes, and our end is not to wait.
            threading.Thread(target=_fork, args=(processes, module, number), daemon=True).start()
        if not said:
            return


def _fork(processes: ForkedProcesses, module: str, number: int) -> None:
    with Connection(number) as connection:
        try:
            processes.start_with(_run, module, connection)
        except NoProcessError as error:
            LOG.error("No estimator can be forked (%s).", error)


def _run(module: str, connection: Connection) -> None:
    cast("Answering", importlib.import_module(module)).answer(connection)
