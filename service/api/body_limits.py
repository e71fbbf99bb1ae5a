"""Limits of requests' bodies: their size, the time they may take, and a clear end.

Of the time only what is spent waiting for the client counts. While the service is not asking for
more, because it is busy or its buffer is full, the client is not late.
"""

import asyncio
import time
from typing import Final

from starlette.requests import Request
from starlette.responses import Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from api_schemas.problems import Problem, problem
from service.api.problems import ProblemError, problem_response

DISCARDED_BYTES: Final = 10_000_000
"""How much of a refused body is read and discarded so that the client reads the answer."""

BYTES_PER_S: Final = 4_000
"""A body gets a second more for each so many bytes that came: the slowest of phones are faster."""

REFUSALS: Final = 400
"""Statuses from here on are not successful, and may be sent before the body was read."""


class BodyLimit:
    """ASGI middleware: answers 413 if the declared or counted size of a body exceeds the limit."""

    def __init__(self, app: ASGIApp, *, max_bytes: int) -> None:
        self._app = app
        self._max_bytes = max_bytes

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, counting its body."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        request = Request(scope)
        declared = request.headers.get("content-length", "")
        if declared.isdecimal() and int(declared) > self._max_bytes:
            answer = problem_response(request, self._too_large())
            await refuse(answer, scope, receive, send, discard_bytes=2 * self._max_bytes)
            return
        received = 0
        # Without a body there is nothing to receive: whoever waits for the end is not disturbed.
        is_whole = declared in ("", "0") and "transfer-encoding" not in request.headers

        async def counted() -> Message:
            nonlocal received, is_whole
            message = await receive()
            received += len(message.get("body", b""))
            is_whole = not _goes_on(message)
            if received > self._max_bytes:
                raise ProblemError(self._too_large())
            return message

        async def after_the_body(message: Message) -> None:
            begins = message["type"] == "http.response.start"
            if begins and message["status"] >= REFUSALS and not is_whole:
                # Refused before it was read: closing now could cost the client the answer.
                await _discard(receive, 2 * self._max_bytes)
            await send(message)

        await self._app(scope, counted, after_the_body)

    def _too_large(self) -> Problem:
        return problem(
            "payload-too-large",
            detail=f"The body exceeds {self._max_bytes} bytes.",
            remedy="Send the picture as JPEG, or scale it down; 1500 pixels are plenty.",
        )


async def refuse(
    answer: Response,
    scope: Scope,
    receive: Receive,
    send: Send,
    *,
    discard_bytes: int = DISCARDED_BYTES,
) -> None:
    """Answer without having looked at the body.

    Most clients read the answer only after sending their body: let them, within reason.
    """
    await _discard(receive, discard_bytes)
    await answer(scope, receive, send)


async def _discard(receive: Receive, most_bytes: int) -> None:
    """Read the rest of the body and discard it."""
    discarded = 0
    while discarded <= most_bytes:
        message = await receive()
        discarded += len(message.get("body", b""))
        if not _goes_on(message):
            return


def _goes_on(message: Message) -> bool:
    return message["type"] == "http.request" and message.get("more_body", False)


AMBIGUOUS: Final = frozenset({"content-length", "transfer-encoding"})


class MessageFraming:
    """ASGI middleware: answers 400 to a body with both a length and a transfer coding, and closes.

    RFC 9112, 6.3: a proxy that goes by the length takes for a second request what here belongs to
    the first, or the other way round. Nothing else that comes on such a connection may be answered.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on if it is clear where it ends."""
        if scope["type"] == "http":
            request = Request(scope)
            if set(request.headers.keys()) >= AMBIGUOUS:
                answer = problem_response(request, _ambiguous(), {"Connection": "close"})
                await refuse(answer, scope, receive, send)
                return
        await self._app(scope, receive, send)


def _ambiguous() -> Problem:
    return problem(
        "malformed-request",
        code="ambiguous-length",
        field="Content-Length",
        detail="The request has both a Content-Length and a Transfer-Encoding.",
        remedy="Send one of the two.",
    )


CLOSE: Final = {"Connection": "close"}
NO_BODY: Final = ("", "0")
LATE: Final = 408


class BodyTimeLimit:
    """ASGI middleware: a body may take a fixed time plus one second per ``bytes_per_s``."""

    def __init__(
        self, app: ASGIApp, *, time_limit_s: float, bytes_per_s: int = BYTES_PER_S
    ) -> None:
        self._app = app
        self._time_limit_s = time_limit_s
        self._bytes_per_s = bytes_per_s

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, timing its body."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        request = Request(scope)
        declared = request.headers.get("content-length", "")
        if declared in NO_BODY and "transfer-encoding" not in request.headers:
            await self._app(scope, receive, send)
            return
        body = _TimedBody(receive, self._time_limit_s, self._bytes_per_s)

        async def noted(message: Message) -> None:
            # Whatever the answer to an incomplete body would have been, the reason is lateness.
            if body.is_late and not body.is_answered and message.get("status") != LATE:
                return
            body.is_answered = True
            await send(message)

        try:
            await self._app(scope, body.receive, noted)
        except Exception:
            # Some layers discard a body before they answer, outside of the problem handlers.
            if not body.is_late or body.is_answered:
                raise
        if body.is_late and not body.is_answered:
            await problem_response(request, body.lateness(), CLOSE)(scope, receive, send)


class _TimedBody:
    """The body of one request."""

    def __init__(self, receive: Receive, time_limit_s: float, bytes_per_s: int) -> None:
        self._receive = receive
        self._time_limit_s = time_limit_s
        self._bytes_per_s = bytes_per_s
        self._waited_s = 0.0
        self._received = 0
        self._is_whole = False
        self.is_late = False
        self.is_answered = False
        """Whether the answer has begun: from then on the body is waited for by nobody."""

    async def receive(self) -> Message:
        """Return the next part, or the end of the request.

        Raises
        ------
        ProblemError
            The first time the body is late; afterwards the client counts as gone.
        """
        if self.is_late:
            return {"type": "http.disconnect"}
        if self._is_whole or self.is_answered:
            return await self._receive()
        began = time.monotonic()
        allowed_s = self._time_limit_s + self._received / self._bytes_per_s - self._waited_s
        try:
            async with asyncio.timeout(allowed_s):
                message = await self._receive()
        except TimeoutError:
            if self.is_answered:
                return await self._receive()
            self.is_late = True
            raise ProblemError(self.lateness(), headers=CLOSE) from None
        self._waited_s += time.monotonic() - began
        self._received += len(message.get("body", b""))
        self._is_whole = not message.get("more_body", False)
        return message

    def lateness(self) -> Problem:
        """The problem that says what was waited for."""
        return problem(
            "request-timeout",
            code="body-too-slow",
            detail=(
                f"Of the body {self._received} bytes came in "
                f"{self._time_limit_s + self._received / self._bytes_per_s:.0f} s."
            ),
            remedy=(
                f"Send it within {self._time_limit_s:g} s, and a second more for each "
                f"{self._bytes_per_s} bytes; a smaller picture takes less."
            ),
        )
