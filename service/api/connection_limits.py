"""How long a connection may take to send a request, and how many there may be.

Uvicorn limits neither. Everything private that we use of uvicorn is in this file, and
``tests/unit/service/test_connection_limits.py`` names it: an upgrade that changes it fails there.
How long a body may take is limited by :mod:`service.api.body_time`, inside the application.
"""

import asyncio
import logging
from dataclasses import dataclass, field
from enum import Enum, auto
from typing import ClassVar, Final, cast

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol

from api_schemas.problems import Problem, problem
from service.api.farewell import Farewell, raw_answer

LOG: Final = logging.getLogger(__name__)

TIME_TO_ASK_S: Final = 1.0
"""A new connection's first bytes may still be on their way: it is not closed within this time."""

MOST_FAREWELLS: Final = 100
"""How many refused connections are kept until the answer is read; others are closed right after it.
"""

FAREWELL_S: Final = 2.0
"""How long a refused client may go on sending before it reads the answer."""

BETWEEN_WARNINGS_S: Final = 60.0


@dataclass(frozen=True, slots=True, kw_only=True)
class ConnectionLimits:
    """The limits of one API process for its connections."""

    max_connections: int
    head_time_limit_s: float
    unread_body_time_limit_s: float
    """How long the rest of a body may take once the request is answered."""


class _Owed(Enum):
    """What a client has begun to send but not finished."""

    NOTHING = auto()
    HEAD = auto()
    UNREAD_BODY = auto()


@dataclass(slots=True)
class _Gate:
    """State shared by the connections of one server."""

    farewells: set[Farewell] = field(default_factory=set)
    warned_at: float = float("-inf")


class LimitedProtocol(H11Protocol):
    """One connection of a server. Made by :func:`limited_protocol`, which sets the limits."""

    limits: ClassVar[ConnectionLimits]
    gate: ClassVar[_Gate]

    _owed = _Owed.NOTHING
    _timer: asyncio.TimerHandle | None = None
    quiet_since = 0.0
    """When it opened or, later, when its last response ended; seconds of the loop's clock."""

    # Annotated with the type of asyncio's base class, unlike in uvicorn.
    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Take a place, or refuse the connection if there is none."""
        transport = cast("asyncio.Transport", transport)
        if len(self.connections) >= self.limits.max_connections and not self._make_room():
            self._warn_that_it_is_full()
            self._bid_farewell(transport, _full())
            return
        super().connection_made(transport)
        self.quiet_since = self.loop.time()
        self._watch()

    def connection_lost(self, exc: Exception | None) -> None:
        """Forget the connection."""
        super().connection_lost(exc)
        self._stop_watching()

    def data_received(self, data: bytes) -> None:
        """Read what has come."""
        super().data_received(data)
        self._watch()

    def on_response_complete(self) -> None:
        """Wait for the next request, or for the rest of this one."""
        super().on_response_complete()
        self.quiet_since = self.loop.time()
        self._watch()

    def send_400_response(self, msg: str) -> None:
        """Refuse what is not HTTP with a problem, like everything else that is refused."""
        self._part(
            problem(
                "malformed-request",
                code="not-http",
                detail=msg,
                remedy="Speak HTTP/1.1, with a head of at most 64 kB.",
            )
        )

    def _watch(self) -> None:
        """Start or stop the timer for what the client has not finished."""
        owed = self._what_is_owed()
        if owed is self._owed:
            return
        self._stop_watching()
        self._owed = owed
        if owed is _Owed.HEAD:
            self._timer = self.loop.call_later(
                self.limits.head_time_limit_s, self._end_for_a_late_head
            )
        elif owed is _Owed.UNREAD_BODY:
            self._timer = self.loop.call_later(
                self.limits.unread_body_time_limit_s, self.transport.close
            )

    def _stop_watching(self) -> None:
        self._owed = _Owed.NOTHING
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _what_is_owed(self) -> _Owed:
        if self.transport.is_closing():
            return _Owed.NOTHING
        if self.conn.their_state is h11.IDLE:
            # Looks for bytes once per head, not with each of them.
            if self._owed is _Owed.HEAD or self.cycle is None or self._has_begun_to_ask():
                return _Owed.HEAD
        elif self.conn.their_state is h11.SEND_BODY and self.cycle.response_complete:
            return _Owed.UNREAD_BODY
        return _Owed.NOTHING

    def _has_begun_to_ask(self) -> bool:
        return bool(self.conn.trailing_data[0])

    def _end_for_a_late_head(self) -> None:
        if self.transport.is_closing():
            return
        if not self._has_begun_to_ask():
            # An unsolicited answer would be taken for that to a request still on its way.
            self.shutdown()
            return
        LOG.info("A request's head took longer than %g s.", self.limits.head_time_limit_s)
        self._part(
            problem(
                "request-timeout",
                code="head-too-slow",
                detail=(
                    f"The head of the request took longer than {self.limits.head_time_limit_s:g} s."
                ),
                remedy="Send the head of a request at once.",
            )
        )

    def _make_room(self) -> bool:
        """Close the connection that has been idle longest, if there is one."""
        quiet = [each for each in self._others() if each.asks_nothing]
        if not quiet:
            return False
        longest = min(quiet, key=lambda each: each.quiet_since)
        longest.shutdown()
        # Its place is free at once, not only when the loop reports the closing.
        self.connections.discard(longest)
        return True

    def _others(self) -> "set[LimitedProtocol]":
        return cast("set[LimitedProtocol]", self.connections)

    @property
    def asks_nothing(self) -> bool:
        """Whether the connection is idle, so that nothing would be lost if it were closed now."""
        if self.conn.their_state is not h11.IDLE or self._has_begun_to_ask():
            return False
        if self.cycle is None:
            return self.loop.time() - self.quiet_since >= TIME_TO_ASK_S
        # The end of a large response may still be on its way.
        return self.cycle.response_complete and self.transport.get_write_buffer_size() == 0

    def _warn_that_it_is_full(self) -> None:
        if self.loop.time() - self.gate.warned_at >= BETWEEN_WARNINGS_S:
            self.gate.warned_at = self.loop.time()
            LOG.warning(
                "All %d connections are busy; further ones are refused (503).",
                self.limits.max_connections,
            )

    def _part(self, reason: Problem) -> None:
        """Answer in place of the application, and close."""
        is_answering = self.cycle is not None and not self.cycle.response_complete
        if is_answering and self.cycle.response_started:
            self.transport.close()
            return
        self._unset_keepalive_if_required()
        self._bid_farewell(self.transport, reason)
        # With a cause: without one uvicorn would close before the answer is read.
        self.connection_lost(ConnectionAbortedError(reason.detail))

    def _bid_farewell(self, transport: asyncio.Transport, reason: Problem) -> None:
        answer = raw_answer(reason, self.server_state.default_headers)
        has_time = len(self.gate.farewells) < MOST_FAREWELLS
        farewell = Farewell(transport, self.gate.farewells, time_limit_s=FAREWELL_S)
        transport.set_protocol(farewell)
        farewell.say(answer)
        if not has_time:
            transport.close()


def limited_protocol(limits: ConnectionLimits) -> type[LimitedProtocol]:
    """Make the protocol class to pass to a server as its ``http``."""

    class ServersProtocol(LimitedProtocol):
        pass

    ServersProtocol.limits = limits
    ServersProtocol.gate = _Gate()
    return ServersProtocol


def _full() -> Problem:
    return problem(
        "too-many-connections",
        detail="All connections that this service allows are busy.",
        remedy="Try again after the time in Retry-After, and keep fewer connections open.",
    )
