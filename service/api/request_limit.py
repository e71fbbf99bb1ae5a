"""How many requests one API process works on at the same time: one more is answered 503.

Event streams count as long as they are followed. Connections that ask nothing do not count: uvicorn
closes them when they are idle, and a proxy ends those that do not finish their question.
"""

from typing import Final

from starlette.requests import Request
from starlette.types import ASGIApp, Receive, Scope, Send

from api_schemas.problems import problem
from service.api.problems import problem_response

MOST: Final = 800
"""Each takes a file descriptor, of which a process usually has 1024."""


class RequestLimit:
    """ASGI middleware: passes on up to ``most`` requests at the same time."""

    def __init__(self, app: ASGIApp, *, most: int = MOST) -> None:
        self._app = app
        self._most = most
        self._running = 0

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, or refuse it."""
        if scope["type"] != "http":
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
