"""Refuse bodies that are too large before anything reads them whole."""

from starlette.requests import Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from api_schemas.problems import Problem, problem
from service.api.problems import ProblemError, problem_response


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
            await self._discard(receive)
            await problem_response(request, self._too_large())(scope, receive, send)
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

    async def _discard(self, receive: Receive) -> None:
        # Most clients read an answer only after they have sent their body: let them, within reason.
        discarded = 0
        while discarded <= 2 * self._max_bytes:
            message = await receive()
            discarded += len(message.get("body", b""))
            if message["type"] != "http.request" or not message.get("more_body", False):
                return

    def _too_large(self) -> Problem:
        return problem(
            "payload-too-large",
            detail=f"The body exceeds {self._max_bytes} bytes.",
            remedy="Send the picture as JPEG, or scale it down; 1500 pixels are plenty.",
        )
