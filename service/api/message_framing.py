"""Refuse requests whose end two readers could see in different places."""

from typing import Final

from starlette.requests import Request
from starlette.types import ASGIApp, Receive, Scope, Send

from api_schemas.problems import Problem, problem
from service.api.body_limit import refuse
from service.api.problems import problem_response

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
