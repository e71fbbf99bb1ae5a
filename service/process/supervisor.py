"""A worker process next to the API, restarted when it dies."""

import contextlib
import logging
import socket
import subprocess
import threading
from collections.abc import Callable, Mapping, Sequence
from typing import Final

LOG: Final = logging.getLogger(__name__)

RESTART_PAUSE_S: Final = 1.0


class SupervisedWorker:
    """A worker process that is restarted whenever it ends without having been asked to.

    The exception is the exit status that says that restarting is of no use: then ``on_final_end``
    is called, and no other is started.

    Its standard input is one end of a socket of ours: if this process is killed, the socket ends
    and the worker stops. What is passed through it, the worker hands to a process that it forks
    (:mod:`service.worker.fork_requests`).
    """

    def __init__(
        self,
        command: Sequence[str],
        *,
        environment: Mapping[str, str],
        stop_timeout_s: float,
        final_code: int,
        on_final_end: Callable[[], object],
    ) -> None:
        self._command = list(command)
        self._environment = dict(environment)
        self._stop_timeout_s = stop_timeout_s
        self._final_code = final_code
        self._on_final_end = on_final_end
        self.has_finally_ended = False
        self._stopping = threading.Event()
        self._lock = threading.Lock()
        self._process, self._line = self._spawn()
        self._thread = threading.Thread(target=self._watch, name="supervisor", daemon=True)
        self._thread.start()

    def pass_on(self, connection: socket.socket) -> None:
        """Have the worker fork a process that holds this connection too.

        Where no worker runs, or it ends before it has forked, nobody else holds it: our other end
        of it has ended once ours is closed.
        """
        with self._lock, contextlib.suppress(OSError):
            socket.send_fds(self._line, [b"+"], [connection.fileno()])

    def stop(self) -> None:
        """Ask the worker to drain and wait for it; kill it if it does not end."""
        with self._lock:
            self._stopping.set()
            process = self._process
            self._line.close()
        try:
            process.wait(self._stop_timeout_s)
        except subprocess.TimeoutExpired:
            LOG.warning("The worker did not stop in time and is killed.")
            process.kill()
        self._thread.join()

    def _spawn(self) -> tuple[subprocess.Popen[bytes], socket.socket]:
        ours, theirs = socket.socketpair()
        # A worker that takes nothing from it is not waited for.
        ours.setblocking(False)
        with theirs:
            # A session of its own: an interrupt from the terminal is for us, who pass it on.
            process = subprocess.Popen(
                self._command, stdin=theirs.fileno(), env=self._environment, start_new_session=True
            )
        return process, ours

    def _watch(self) -> None:
        while True:
            code = self._process.wait()
            if self._stopping.is_set():
                return
            if code == self._final_code:
                LOG.error("The worker cannot run as the service is set up; the service stops.")
                self.has_finally_ended = True
                self._on_final_end()
                return
            LOG.error("The worker ended with code %d; starting another.", code)
            self._stopping.wait(RESTART_PAUSE_S)
            with self._lock:
                if self._stopping.is_set():
                    return
                self._line.close()
                self._process, self._line = self._spawn()
