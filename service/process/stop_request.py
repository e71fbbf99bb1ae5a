"""A request to stop, which a signal may bring at any moment."""

import queue
from typing import Final

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
