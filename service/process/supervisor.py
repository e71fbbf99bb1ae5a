"""Processes of ours: how they are started, and one beside the API that is always there."""

import logging
import subprocess
import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from typing import Final

PYTHON: Final = (sys.executable, "-P")
"""``python -m`` alone looks for every module in the current folder first: an ``http.py`` in the
folder a service is started in would be run. With ``-P`` it does not; PYTHONPATH counts as ever."""

SAFE_PATH_VARIABLE: Final = "PYTHONSAFEPATH"
"""The same for processes whose command is not ours, and for those that they start."""

LOG: Final = logging.getLogger(__name__)

RESTART_PAUSE_S: Final = 1.0


class SupervisedProcess:
    """A process that is restarted whenever it ends without having been asked to.

    The exception is ``final_code``, the exit status that says that restarting is of no use: then
    ``on_final_end`` is called, and no other is started.

    Its standard input is a pipe from us: if we are killed the pipe ends, and the process stops.
    """

    def __init__(
        self,
        command: Sequence[str],
        *,
        name: str,
        environment: Mapping[str, str],
        stop_timeout_s: float,
        final_code: int | None = None,
        on_final_end: Callable[[], object] = lambda: None,
    ) -> None:
        self._command = list(command)
        self._name = name
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
        """Ask the process to stop and wait for it; kill it if it does not end."""
        with self._lock:
            self._stopping.set()
            process = self._process
            _close_line(process)
        try:
            process.wait(self._stop_timeout_s)
        except subprocess.TimeoutExpired:
            LOG.warning("The %s did not stop in time and is killed.", self._name)
            process.kill()
        self._thread.join()

    def _spawn(self) -> subprocess.Popen[bytes]:
        # A session of its own: an interrupt from the terminal is for us, who pass it on.
        return subprocess.Popen(
            self._command, stdin=subprocess.PIPE, env=self._environment, start_new_session=True
        )

    def _watch(self) -> None:
        while True:
            code = self._process.wait()
            if self._stopping.is_set():
                return
            if code == self._final_code:
                LOG.error(
                    "The %s cannot run as the service is set up; the service stops.", self._name
                )
                self.has_finally_ended = True
                self._on_final_end()
                return
            LOG.error("The %s ended with code %d; starting another.", self._name, code)
            self._stopping.wait(RESTART_PAUSE_S)
            with self._lock:
                if self._stopping.is_set():
                    return
                _close_line(self._process)
                self._process = self._spawn()


def _close_line(process: subprocess.Popen[bytes]) -> None:
    assert process.stdin is not None
    process.stdin.close()
