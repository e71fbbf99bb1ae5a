"""Processes forked from a server that has the numerics loaded."""

import contextlib
import logging
import os
import select
import signal
import threading
import time
from collections.abc import Callable, Iterator
from multiprocessing import forkserver, get_context
from multiprocessing.connection import Connection
from multiprocessing.context import ForkServerContext, ForkServerProcess
from typing import Final

LOG: Final = logging.getLogger(__name__)

DEATHS: Final = 5
"""How often in a row the server may die before it is taken to be unable to fork at all."""

FIRST_PAUSE_S: Final = 0.1
DOUBLINGS: Final = 8
"""Pauses between two tries to start the server: up to 26 s, as one that dies takes seconds each
time to load."""


class NoProcessError(Exception):
    """No process can be forked now."""


class ForkedProcesses:
    """Starts processes; the caller ends each with :func:`end`.

    A fork takes 0.02 s, a fresh interpreter most of a second. The server itself has no threads,
    which is what makes forking safe. A server that dies is started again. While it dies time after
    time, nobody waits for it: starting a process fails at once, and :meth:`is_able` says no.
    """

    def __init__(self, *preload: str) -> None:
        self._context: ForkServerContext = get_context("forkserver")
        self._context.set_forkserver_preload(list(preload))
        self._lock = threading.Lock()
        self._deaths = 0
        self._has_forked = threading.Event()

    def begin_preloading(self) -> None:
        """Start the server, which then loads the numerics in the background, and keep it running.

        Returns at once.
        """
        forkserver.ensure_running()
        threading.Thread(target=self._keep_running, name="fork server", daemon=True).start()

    def is_able(self) -> bool:
        """Say whether the server has forked the process that it was asked for last."""
        return self._has_forked.is_set()

    def start(
        self, target: Callable[..., None], *arguments: object
    ) -> tuple[Connection, ForkServerProcess]:
        """Run ``target`` in a process, with the arguments and one end of the pipe returned.

        Raises
        ------
        NoProcessError
            If the server dies, however often it is started.
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

    def start_with(self, target: Callable[..., None], *arguments: object) -> None:
        """Run ``target`` in a process that nobody here waits for.

        Raises
        ------
        NoProcessError
            If the server dies, however often it is started.
        """
        self._started(target, arguments)

    def replace_server(self) -> None:
        """End the server: what it has read may have been damaged since. Another one takes over."""
        with contextlib.suppress(NoProcessError, ProcessLookupError):
            server = self._server_number()
            self._has_forked.clear()
            os.kill(server, signal.SIGKILL)

    def _started(
        self, target: Callable[..., None], arguments: tuple[object, ...]
    ) -> ForkServerProcess:
        while True:
            process = self._context.Process(target=target, args=arguments)
            try:
                process.start()
            except (EOFError, OSError) as error:
                # The server has just died, or the machine has no room for a process.
                deaths = self._count_death()
                if deaths >= DEATHS:
                    raise NoProcessError(str(error) or type(error).__name__) from error
                LOG.warning("The fork server died (%s).", error or type(error).__name__)
                time.sleep(_pause_s(deaths))
            else:
                with self._lock:
                    self._deaths = 0
                    self._has_forked.set()
                return process

    def _count_death(self) -> int:
        with self._lock:
            self._deaths += 1
            if self._deaths >= DEATHS:
                self._has_forked.clear()
            return self._deaths

    def _keep_running(self) -> None:
        """Start the server again whenever it has ended, though nobody asks for a process."""
        while True:
            began = time.monotonic()
            try:
                server = self._server_number()
            except NoProcessError as error:
                LOG.error("The fork server dies time after time (%s): no job can run.", error)
                time.sleep(_pause_s(self._deaths))
                continue
            LOG.info("The numerics are loaded (%.1f s).", time.monotonic() - began)
            if not _wait_for_end(server):
                return
            LOG.warning("The fork server has ended; starting another.")

    def _server_number(self) -> int:
        """The server's process number, as a process knows it that is forked to tell it."""
        connection, process = self.start(_tell_parent)
        try:
            return int(connection.recv())
        except (EOFError, OSError) as error:
            raise NoProcessError(str(error) or type(error).__name__) from error
        finally:
            end(connection, process)


def _wait_for_end(server: int) -> bool:
    """Wait until the process has ended; False where that cannot be watched."""
    try:
        descriptor = os.pidfd_open(server)
    except ProcessLookupError:
        return True
    except (AttributeError, OSError):
        return False
    poll = select.poll()
    poll.register(descriptor, select.POLLIN)
    poll.poll()
    os.close(descriptor)
    return True


def _pause_s(deaths: int) -> float:
    doublings = min(deaths - 1, DOUBLINGS)
    return FIRST_PAUSE_S * 2.0**doublings


def _tell_parent(connection: Connection) -> None:
    """What a process does that is forked only to see that it can be."""
    # The worker may have ended meanwhile.
    with contextlib.suppress(OSError):
        connection.send(os.getppid())


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
