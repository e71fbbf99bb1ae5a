"""A wish to stop that a signal may bring at any moment."""

import queue


class StopRequest:
    """Asked for by a signal handler or another thread, waited for by the main thread.

    ``threading.Event`` will not do: for a moment in ``wait`` the main thread has its lock, and a
    handler that sets it then waits for that lock for ever. A ``SimpleQueue`` may be put to from a
    handler.
    """

    def __init__(self) -> None:
        self._asked: queue.SimpleQueue[None] = queue.SimpleQueue()

    def ask(self) -> None:
        """Ask for it; however often."""
        self._asked.put(None)

    def wait(self) -> None:
        """Return once it is asked for."""
        self._asked.get()
