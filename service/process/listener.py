"""The API's listening socket, which turns connections away before descriptors run out.

Without a proxy in front, half-finished requests would use up all descriptors: nobody would be
answered any more, and asyncio would log every attempt to accept one.
"""

import errno
import logging
import resource
import socket
import time
from typing import Any, Final

from service.settings import SettingError, Settings

LOG: Final = logging.getLogger(__name__)

KEPT_DESCRIPTORS: Final = 256
"""For database, storage, files, and the pipes of other processes."""

MOST_CONNECTIONS: Final = 10_000
"""However many descriptors there are: each connection takes some 20 kB."""

LOOK_S: Final = 0.1
"""Least interval between looks for closed connections while there seem to be too many, seconds."""

TOLD_EVERY_S: Final = 60.0


class Listener(socket.socket):
    """A listening socket that closes what it accepts while ``most`` connections are open."""

    def __init__(self, family: socket.AddressFamily, *, most: int) -> None:
        # With the protocol given explicitly, asyncio sends what is written at once: otherwise each
        # response on a kept-alive connection would wait 40 ms until its headers are acknowledged.
        super().__init__(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
        self._most = most
        self._accepted: set[socket.socket] = set()
        self._looked_at = self._told_at = -TOLD_EVERY_S

    def accept(self) -> tuple[socket.socket, Any]:
        """Accept a connection.

        Raises
        ------
        ConnectionAbortedError
            If it was turned away; asyncio then looks again.
        """
        connection, address = super().accept()
        now = time.monotonic()
        if len(self._accepted) >= self._most and now - self._looked_at >= LOOK_S:
            self._looked_at = now
            self._accepted = {each for each in self._accepted if each.fileno() >= 0}
        if len(self._accepted) < self._most:
            self._accepted.add(connection)
            return connection, address
        connection.close()
        if now - self._told_at >= TOLD_EVERY_S:
            self._told_at = now
            LOG.warning("%d connections are open: more are turned away.", self._most)
        raise ConnectionAbortedError


def listen(settings: Settings) -> Listener:
    """Bind the API's address; port 0 takes a free one.

    Raises
    ------
    OSError
        If something else is listening there.
    SettingError
        If it is impossible to listen on the address.
    """
    family = socket.AF_INET6 if ":" in settings.host else socket.AF_INET
    listener = Listener(family, most=connection_limit(_descriptors()))
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((settings.host, settings.port))
    except OSError as error:
        listener.close()
        if error.errno == errno.EADDRINUSE:
            raise
        reason = (
            f"it cannot be listened on port {settings.port} there ({error.strerror}); name an "
            "address of this machine, and a port above 1023"
        )
        raise SettingError(reason, name="host", value=settings.host) from error
    return listener


def connection_limit(descriptors: int) -> int:
    """Number of connections that may be open with so many descriptors."""
    return min(max(descriptors - KEPT_DESCRIPTORS, descriptors // 2), MOST_CONNECTIONS)


def _descriptors() -> int:
    """Raise the limit of open descriptors as far as this process may, and return it."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if hard == resource.RLIM_INFINITY:
        return 2 * MOST_CONNECTIONS if soft == resource.RLIM_INFINITY else soft
    resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
    return hard
