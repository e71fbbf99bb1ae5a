"""Processes forked from a server that has the numerics loaded."""

import contextlib
import sys
import threading
from collections.abc import Callable, Iterator
from multiprocessing import forkserver, get_context
from multiprocessing.connection import Connection
from multiprocessing.context import ForkServerContext, ForkServerProcess

from service.process.retrying import retry_with_pauses


class NoProcessError(Exception):
    """No process can be forked now."""


class ForkedProcesses:
    """Starts processes; the caller ends each with :func:`end`.

    A fork takes 0.02 s, a fresh interpreter most of a second. The server itself has no threads,
    which is what makes forking safe. A server that dies is started again.
    """

    def __init__(self, *preload: str) -> None:
        self._context: ForkServerContext = get_context("forkserver")
        _keep_main_to_ourselves()
        self._context.set_forkserver_preload(list(preload))

    def begin_preloading(self) -> None:
        """Start the server, which then loads the numerics in the background."""
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
        try:
            process = self._started(target, (*arguments, theirs))
        except NoProcessError:
            ours.close()
            raise
        finally:
            theirs.close()
        return ours, process

    @retry_with_pauses(NoProcessError, "fork server")
    def start_with(self, target: Callable[..., None], *arguments: object) -> None:
        """Run ``target`` in a process that nobody here waits for.

        Raises
        ------
        NoProcessError
            If no process could be started for two minutes.
        """
        self._started(target, arguments)

    def _started(
        self, target: Callable[..., None], arguments: tuple[object, ...]
    ) -> ForkServerProcess:
        process = self._context.Process(target=target, args=arguments)
        try:
            process.start()
        except (EOFError, OSError) as error:
            # The server has just died, or the machine has no room for a process.
            raise NoProcessError(str(error) or type(error).__name__) from error
        return process


def _keep_main_to_ourselves() -> None:
    """Have children not import the program that was started: what they run is imported by name.

    It takes a child a fiftieth of what a fit takes to import the command line anew.
    """
    main = sys.modules["__main__"]
    main.__spec__ = None
    main.__dict__.pop("__file__", None)


def _nothing(_: Connection) -> None:
    """What a process does that is forked only to see that it can be."""


def end(connection: Connection, process: ForkServerProcess) -> None:
    """Kill the process if it is still running, and release all its resources."""
    connection.close()
    process.kill()
    process.join()
    process.close()


@contextlib.contextmanager
def killed_in_time(process: ForkServerProcess, limit_s: float) -> Iterator[None]:
    """Kill the process after ``limit_s`` seconds, whatever the caller is doing by then."""

    def kill() -> None:
        # Already closed if it ended just now.
        with contextlib.suppress(ValueError):
            process.kill()

    watchdog = threading.Timer(limit_s, kill)
    watchdog.daemon = True
    watchdog.start()
    try:
        yield
    finally:
        watchdog.cancel()
