"""A worker process next to the API, restarted when it dies."""

import logging
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

    Its standard input is the reading end of a pipe of ours: if this process is killed, the pipe
    ends and the worker stops.
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
                self._process = self._spawn()
