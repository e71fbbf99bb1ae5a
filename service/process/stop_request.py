"""A request to stop, which a signal may bring at any moment, or the end of who started us."""

import os
import queue
import signal
import sys
import threading
from typing import Final

READ_AT_ONCE: Final = 4_096

NOTICED_WITHIN_S: Final = 0.5
"""How late a stop may be noticed that was requested in the moment a wait began."""


class StopRequest:
    """Set by a signal handler or another thread, waited for by the main thread.

    ``threading.Event`` will not do: for a moment in ``wait`` the main thread holds its lock, and a
    handler that sets the event then would wait for that lock for ever. Putting to a ``SimpleQueue``
    is safe in a handler.

    A signal that arrives after Python's last look for signals and before the wait sleeps does not
    wake it, and its handler runs when the wait ends: so a wait ends now and then, and begins anew.
    """

    def __init__(self) -> None:
        self._asked: queue.SimpleQueue[None] = queue.SimpleQueue()

    def ask(self) -> None:
        """Request the stop; may be called repeatedly."""
        self._asked.put(None)

    def wait(self) -> None:
        """Return once a stop has been requested."""
        while True:
            try:
                return self._asked.get(timeout=NOTICED_WITHIN_S)
            except queue.Empty:
                continue

    def on_signals(self) -> None:
        """Let SIGTERM and SIGINT ask."""
        for number in (signal.SIGTERM, signal.SIGINT):
            signal.signal(number, lambda _number, _frame: self.ask())

    def with_starter(self) -> None:
        """Let the end of standard input ask: whoever started this process has ended, or wants it.

        Read in a thread, and not through sys.stdin: a reader that holds its lock keeps the
        interpreter from ending.
        """

        def follow() -> None:
            while os.read(sys.stdin.fileno(), READ_AT_ONCE):
                pass
            self.ask()

        threading.Thread(target=follow, name="starter", daemon=True).start()
