"""How long a body may take: clients that send it byte by byte get 408.

Only the time spent waiting for the client counts. While the service is not asking for more, because
it is busy or its buffer is full, the client is not late.
"""

import asyncio
import time
from typing import Final

from starlette.requests import Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from api_schemas.problems import Problem, problem
from service.api.problems import ProblemError, problem_response

CLOSE: Final = {"Connection": "close"}
NO_BODY: Final = ("", "0")
LATE: Final = 408


class BodyTimeLimit:
    """ASGI middleware: a body may take a fixed time plus one second per ``bytes_per_s``."""

    def __init__(self, app: ASGIApp, *, time_limit_s: float, bytes_per_s: int) -> None:
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
