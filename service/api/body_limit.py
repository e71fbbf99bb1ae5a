"""Refuse bodies that are too large before anything reads them whole."""

from typing import Final

from starlette.requests import Request
from starlette.responses import Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from api_schemas.problems import Problem, problem
from service.api.problems import ProblemError, problem_response

DISCARDED_BYTES: Final = 10_000_000
"""How much of a body is read and thrown away before it is refused unread."""


class BodyLimit:
    """ASGI middleware: a declared or counted body above the limit is answered with 413."""

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

        async def counted() -> Message:
            nonlocal received
            message = await receive()
            received += len(message.get("body", b""))
            if received > self._max_bytes:
                raise ProblemError(self._too_large())
            return message

        await self._app(scope, counted, send)

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

    Most clients read an answer only after they have sent their body: let them, within reason.
    """
    discarded = 0
    while discarded <= discard_bytes:
        message = await receive()
        discarded += len(message.get("body", b""))
        if message["type"] != "http.request" or not message.get("more_body", False):
            break
    await answer(scope, receive, send)
