"""Processes forked from a server that has the numerics loaded."""

import contextlib
import threading
from collections.abc import Callable, Iterator
from multiprocessing import forkserver, get_context
from multiprocessing.connection import Connection
from multiprocessing.context import ForkServerContext, ForkServerProcess

from service.process.retrying import retry_with_pauses


class NoProcessError(Exception):
    """No process can be forked now."""


class ForkedProcesses:
    """Starts processes; the caller ends each by :func:`end`.

    A fork takes 0.02 s where a fresh interpreter takes most of a second, and the server itself
    stays without threads, which is what makes forking safe. A server that dies is started again.
    """

    def __init__(self, preload: str) -> None:
        self._context: ForkServerContext = get_context("forkserver")
        self._context.set_forkserver_preload([preload])

    def begin_preloading(self) -> None:
        """Start the server, which loads the numerics by itself."""
        forkserver.ensure_running()

    def wait_until_loaded(self) -> None:
        """Wait until the server has loaded the numerics; only then it forks.

        Raises
        ------
        NoProcessError
            If no process could be started for two minutes.
        """
        connection, process = self.start(_nothing)
        end(connection, process)

    @retry_with_pauses(NoProcessError, "fork server")
    def start(
        self, target: Callable[..., None], *arguments: object
    ) -> tuple[Connection, ForkServerProcess]:
        """Run ``target`` in a process, with the arguments and one end of the pipe returned.

        Raises
        ------
        NoProcessError
            If no process could be started for two minutes.
        """
        ours, theirs = self._context.Pipe()
        process = self._context.Process(target=target, args=(*arguments, theirs))
        try:
            process.start()
        except (EOFError, OSError) as error:
            # The server died this moment, or the machine has no room for a process.
            ours.close()
            raise NoProcessError(str(error) or type(error).__name__) from error
        finally:
            theirs.close()
        return ours, process


def _nothing(_: Connection) -> None:
    """What a process does that is forked only to see that it can be."""


def end(connection: Connection, process: ForkServerProcess) -> None:
    """Kill the process if it still runs, and release all there was to it."""
    connection.close()
    process.kill()
    process.join()
    process.close()


@contextlib.contextmanager
def killed_in_time(process: ForkServerProcess, limit_s: float) -> Iterator[None]:
    """Kill the process after so many seconds, whatever the caller is at by then."""

    def kill() -> None:
        # Closed by now if it ended in this very moment.
        with contextlib.suppress(ValueError):
            process.kill()

    watchdog = threading.Timer(limit_s, kill)
    watchdog.daemon = True
    watchdog.start()
    try:
        yield
    finally:
        watchdog.cancel()
