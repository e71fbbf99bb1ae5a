"""Limits of what is asked: how much at a time, how often, and how large and slow a body may be.

Of a body's time only what is spent waiting for the client counts. While the service is not asking
for more, because it is busy or its buffer is full, the client is not late.
"""

import asyncio
import math
import time
from collections.abc import Callable
from typing import Final

from starlette.requests import Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from api_schemas.problems import Problem, problem
from service.api.problems import ProblemError, problem_response

MOST_REQUESTS: Final = 800
"""Each takes a file descriptor, of which a process usually has 1024."""

PROBES: Final = ("/healthz/", "/metrics")
"""Requested by machines every few seconds. A service that is busy is not taken for a dead one."""

BYTES_PER_S: Final = 4_000
"""A body gets a second more for each so many bytes that came: the slowest of phones are faster."""

REFUSALS: Final = 400
"""Statuses from here on are not successful, and may be sent before the body was read."""

CLOSE: Final = {"Connection": "close"}
AMBIGUOUS: Final = frozenset({"content-length", "transfer-encoding"})
LATE: Final = 408


class RequestLimit:
    """ASGI middleware: works on up to ``most`` requests at a time; one more is answered 503.

    Probes are answered whatever else is.
    Event streams count as long as they are followed. Connections that ask nothing do not count:
    uvicorn closes them when they are idle, and a proxy ends those that do not finish their
    question.
    """

    def __init__(self, app: ASGIApp, *, most: int = MOST_REQUESTS) -> None:
        self._app = app
        self._most = most
        self._running = 0

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, or refuse it."""
        if scope["type"] != "http" or scope["path"].startswith(PROBES):
            await self._app(scope, receive, send)
            return
        if self._running >= self._most:
            refused = problem(
                "too-many-connections",
                detail="All connections that this service allows are busy.",
                remedy="Try again after the time in Retry-After, and keep fewer connections open.",
            )
            # Without "Connection: close": uvicorn reads what is still being sent, and the client
            # reads the answer. A connection closed at once would be reset.
            await problem_response(Request(scope), refused)(scope, receive, send)
            return
        self._running += 1
        try:
            await self._app(scope, receive, send)
        finally:
            self._running -= 1


class RateLimit:
    """At most ``per_minute`` requests per minute and key, in bursts of up to as many.

    A bucket for each key of this process, which fills evenly; for use from a single event loop.
    Where several processes must allow no more than one, the proxy before them limits.
    """

    def __init__(self, *, per_minute: int, monotonic: Callable[[], float] = time.monotonic) -> None:
        self._capacity = float(per_minute)
        self._per_second = per_minute / 60.0
        self._monotonic = monotonic
        self._buckets: dict[str, tuple[float, float]] = {}
        """The number of requests that may pass, and the moment this was so, for each key."""

    def take(self, key: str) -> int:
        """Let a request pass and return 0, or return the whole seconds until one may pass."""
        now = self._monotonic()
        left, since = self._buckets.get(key, (self._capacity, now))
        left = min(self._capacity, left + (now - since) * self._per_second)
        passes = left >= 1.0
        self._buckets[key] = (left - passes, now)
        return 0 if passes else max(1, math.ceil((1.0 - left) / self._per_second))


class BodyLimits:
    """ASGI middleware: limits of a body's size and time, and one clear end.

    A refusal is sent only after the rest of the body was read and thrown away, within reason: most
    clients read the answer after they have sent their body, and closing could cost them the answer.
    """

    def __init__(
        self, app: ASGIApp, *, max_bytes: int, time_limit_s: float, bytes_per_s: int = BYTES_PER_S
    ) -> None:
        self._app = app
        self._max_bytes = max_bytes
        self._time_limit_s = time_limit_s
        self._bytes_per_s = bytes_per_s

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, counting and timing its body."""
        if scope["type"] != "http" or not _has_body(request := Request(scope)):
            await self._app(scope, receive, send)
            return
        body = _Body(
            receive,
            max_bytes=self._max_bytes,
            time_limit_s=self._time_limit_s,
            bytes_per_s=self._bytes_per_s,
        )

        is_replaced = False

        async def checked(message: Message) -> None:
            nonlocal is_replaced
            if message["type"] == "http.response.start":
                if message["status"] >= REFUSALS:
                    await body.discard()
                # Whatever the answer to half a body would have been, the reason is lateness.
                is_replaced = body.is_late and message["status"] != LATE
                body.is_answered = not is_replaced
            if not is_replaced:
                await send(message)

        app = self._refusal(request) or self._app
        try:
            await app(scope, body.receive, checked)
        except Exception:
            if not body.is_late or body.is_answered:
                raise
        if body.is_late and not body.is_answered:
            await problem_response(request, body.lateness(), CLOSE)(scope, receive, send)

    def _refusal(self, request: Request) -> ASGIApp | None:
        """The answer to a body that is not to be read."""
        if set(request.headers.keys()) >= AMBIGUOUS:
            return problem_response(request, _ambiguous(), CLOSE)
        declared = request.headers.get("content-length", "")
        if declared.isdecimal() and int(declared) > self._max_bytes:
            return problem_response(request, _too_large(self._max_bytes))
        return None


def _has_body(request: Request) -> bool:
    # Without a body there is nothing to receive: whoever waits for the end is not disturbed.
    declared = request.headers.get("content-length", "")
    return declared not in ("", "0") or "transfer-encoding" in request.headers


def _ambiguous() -> Problem:
    """The problem of a body with two ends.

    RFC 9112, 6.3: a proxy that goes by the length takes for a second request what here belongs to
    the first, or the other way round. Nothing else that comes on such a connection may be answered.
    """
    return problem(
        "malformed-request",
        code="ambiguous-length",
        field="Content-Length",
        detail="The request has both a Content-Length and a Transfer-Encoding.",
        remedy="Send one of the two.",
    )


def _too_large(max_bytes: int) -> Problem:
    return problem(
        "payload-too-large",
        detail=f"The body exceeds {max_bytes} bytes.",
        remedy="Send the picture as JPEG, or scale it down; 1500 pixels are plenty.",
    )


class _Body:
    """The body of one request."""

    def __init__(
        self, receive: Receive, *, max_bytes: int, time_limit_s: float, bytes_per_s: int
    ) -> None:
        self._receive = receive
        self._max_bytes = max_bytes
        self._time_limit_s = time_limit_s
        self._bytes_per_s = bytes_per_s
        self._waited_s = 0.0
        self._received = 0
        self._is_whole = False
        self.is_late = False
        self.is_answered = False
        """True once the answer has begun: from then on nobody waits for the body."""

    async def receive(self) -> Message:
        """Return the next part, or the end of the request.

        Raises
        ------
        ProblemError
            If the body is too large; the first time it is late, afterwards the client counts as
            gone.
        """
        if self.is_late:
            return {"type": "http.disconnect"}
        message = await self._next()
        if self.is_late:
            raise ProblemError(self.lateness(), headers=CLOSE)
        if self._received > self._max_bytes:
            raise ProblemError(_too_large(self._max_bytes))
        return message

    async def discard(self) -> None:
        """Read and throw away the rest, unless it is late or endless."""
        while not (self._is_whole or self.is_late) and self._received <= 3 * self._max_bytes:
            await self._next()

    async def _next(self) -> Message:
        if self._is_whole or self.is_answered:
            return await self._receive()
        began = time.monotonic()
        try:
            async with asyncio.timeout(self._allowed_s() - self._waited_s):
                message = await self._receive()
        except TimeoutError:
            if self.is_answered:
                return await self._receive()
            self.is_late = True
            return {"type": "http.disconnect"}
        self._waited_s += time.monotonic() - began
        self._received += len(message.get("body", b""))
        self._is_whole = not message.get("more_body", False)
        return message

    def _allowed_s(self) -> float:
        return self._time_limit_s + self._received / self._bytes_per_s

    def lateness(self) -> Problem:
        """The problem that says what was waited for."""
        return problem(
            "request-timeout",
            code="body-too-slow",
            detail=f"Of the body {self._received} bytes came in {self._allowed_s():.0f} s.",
            remedy=(
                f"Send it within {self._time_limit_s:g} s, and a second more for each "
                f"{self._bytes_per_s} bytes; a smaller picture takes less."
            ),
        )
