"""A request to stop, which a signal may bring at any moment."""

import queue


class StopRequest:
    """Set by a signal handler or another thread, waited for by the main thread.

    ``threading.Event`` will not do: for a moment in ``wait`` the main thread holds its lock, and a
    handler that sets the event then would wait for that lock for ever. Putting to a ``SimpleQueue``
    is safe in a handler.
    """

    def __init__(self) -> None:
        self._asked: queue.SimpleQueue[None] = queue.SimpleQueue()

    def ask(self) -> None:
        """Request the stop; may be called repeatedly."""
        self._asked.put(None)

    def wait(self) -> None:
        """Return once a stop has been requested."""
        self._asked.get()
