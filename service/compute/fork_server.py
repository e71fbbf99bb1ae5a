"""Children forked from a server that has the numerics loaded, as their owner sees them."""

import contextlib
import logging
import shutil
import tempfile
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from multiprocessing import forkserver, get_context
from multiprocessing.connection import Connection
from multiprocessing.context import ForkServerContext, ForkServerProcess
from pathlib import Path
from typing import Final

from service.compute import child
from service.compute.messages import Message, Received, receive, send
from service.compute.tasks import ChildSetup

LOG: Final = logging.getLogger(__name__)

SECRETLESS: Final = "service.compute.secretless"
"""The module that the server imports before any other."""

DEATHS: Final = 5
"""Deaths of the server in a row, after which it is taken to be unable to fork at all."""

FIRST_PAUSE_S: Final = 0.1
"""Pause before the server is started again; twice as long each time."""

LOOK_S: Final = 5.0
"""Pause between two looks whether the server is able."""


class NoProcessError(Exception):
    """No process can be forked now."""


class Child:
    """A process that does tasks (:mod:`service.compute.child`)."""

    def __init__(self, connection: Connection, process: ForkServerProcess) -> None:
        self._connection = connection
        self._process = process

    def give(self, message: Message, parts: Iterable[bytes]) -> None:
        """Send it a task."""
        send(self._connection, message, parts)

    def receive(self, timeout_s: float | None = None) -> Received | None:
        """Return what it sends next, or None if that does not begin in time.

        Raises
        ------
        EOFError, OSError, ValidationError
            If it has ended, or sends what is no message of ours.
        """
        return receive(self._connection) if self._connection.poll(timeout_s) else None

    def is_waiting(self) -> bool:
        """Whether it is alive and says nothing that nobody asked for."""
        return self._process.is_alive() and not self._connection.poll()

    def exit_code(self, within_s: float) -> int | None:
        """Its exit code, or None if it does not end in time."""
        self._process.join(within_s)
        return self._process.exitcode

    @contextlib.contextmanager
    def killed_in_time(self, limit_s: float) -> Iterator[None]:
        """Kill it after ``limit_s`` seconds, whatever the caller is doing by then."""
        watchdog = threading.Timer(limit_s, self._kill)
        watchdog.daemon = True
        watchdog.start()
        try:
            yield
        finally:
            watchdog.cancel()

    def end(self) -> None:
        """Kill it if it is still running, and release all its resources."""
        end(self._connection, self._process)

    def _kill(self) -> None:
        # Already closed if it ended just now.
        with contextlib.suppress(ValueError):
            self._process.kill()


class ForkServer:
    """Starts children; the caller ends each.

    A fork takes 0.02 s, a fresh interpreter most of a second. The server itself has no threads,
    which is what makes forking safe. A server that dies is started again. While it dies time after
    time, nobody waits for it: starting a process fails at once, and :meth:`is_able` says no.
    """

    def __init__(self, *preload: str) -> None:
        self._context: ForkServerContext = get_context("forkserver")
        self._context.set_forkserver_preload([SECRETLESS, *preload])
        self._lock = threading.Lock()
        self._deaths = 0
        self._has_forked = threading.Event()

    def begin_preloading(self) -> None:
        """Start the server, which then loads the numerics in the background.

        Returns at once.
        """
        forkserver.ensure_running()
        threading.Thread(target=self._keep_able, name="fork server", daemon=True).start()

    def is_able(self, within_s: float = 0.0) -> bool:
        """Say whether the server has forked the process that it was asked for last, or soon has."""
        return self._has_forked.wait(within_s)

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

    def start_child(self, setup: ChildSetup) -> Child:
        """Start a child that waits for tasks; raises as :meth:`start` does."""
        return Child(*self.start(child.work, setup))

    def _started(
        self, target: Callable[..., None], arguments: tuple[object, ...]
    ) -> ForkServerProcess:
        while True:
            # Ended with this process, which would wait for them otherwise.
            process = self._context.Process(target=target, args=arguments, daemon=True)
            try:
                process.start()
            except (EOFError, OSError) as error:
                # The server has just died, or the machine has no room for a process.
                deaths = self._count_death()
                if deaths >= DEATHS:
                    raise NoProcessError(str(error) or type(error).__name__) from error
                LOG.warning("The fork server died (%s).", error or type(error).__name__)
                time.sleep(FIRST_PAUSE_S * 2.0 ** (deaths - 1))
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

    def _keep_able(self) -> None:
        """Have a process forked until that succeeds, though nobody asks for one."""
        began = time.monotonic()
        while True:
            if not self.is_able():
                try:
                    end(*self.start(_nothing))
                    LOG.info("The numerics are loaded (%.1f s).", time.monotonic() - began)
                except NoProcessError as error:
                    LOG.error("The fork server dies time after time (%s): no job can run.", error)
            time.sleep(LOOK_S)


def _nothing(_: Connection) -> None:
    """Work of a process that is forked only to see that it can be."""


def end(connection: Connection, process: ForkServerProcess) -> None:
    """Kill the process if it is still running, and release all its resources."""
    connection.close()
    process.kill()
    process.join()
    shutil.rmtree(Path(tempfile.gettempdir(), str(process.pid)), ignore_errors=True)
    process.close()
