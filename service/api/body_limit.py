"""Refuse bodies that are too large before anything reads them in full."""

from typing import Final

from starlette.requests import Request
from starlette.responses import Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from api_schemas.problems import Problem, problem
from service.api.problems import ProblemError, problem_response

DISCARDED_BYTES: Final = 10_000_000
"""How much of a refused body is read and discarded so that the client reads the answer."""

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
