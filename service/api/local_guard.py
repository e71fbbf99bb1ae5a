"""Without API keys, only this machine's own pages and programs may send requests.

A service on a loopback address can still be reached by every page open in a browser on the machine.
There are two ways: a site that resolves its own name to 127.0.0.1 (its pages could then read
answers), and a form that posts to us (its pages could submit, though not read). The first shows in
the Host header, the second in Origin.
"""

from typing import Final
from urllib.parse import SplitResult, urlsplit

from starlette.requests import Request
from starlette.types import ASGIApp, Receive, Scope, Send

from api_schemas.problems import Problem, problem
from service.api.body_limits import refuse
from service.api.problems import problem_response
from service.setting_types import is_loopback

HARMLESS: Final = frozenset({"GET", "HEAD", "OPTIONS"})


class LocalGuard:
    """ASGI middleware: answers 403 to foreign hosts, and to changes requested by foreign pages."""

    def __init__(self, app: ASGIApp, *, allowed_origins: tuple[str, ...]) -> None:
        self._app = app
        self._allowed_origins = frozenset(allowed_origins)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on if it comes from here."""
        if scope["type"] == "http":
            request = Request(scope)
            reason = self._objection(request)
            if reason is not None:
                await refuse(problem_response(request, reason), scope, receive, send)
                return
        await self._app(scope, receive, send)

    def _objection(self, request: Request) -> Problem | None:
        host = request.headers.get("host", "")
        if not is_loopback(_split(f"//{host}").hostname or ""):
            return problem(
                "forbidden",
                code="host-not-allowed",
                detail="Without API keys the service answers to names of this machine only.",
                remedy="Ask for 127.0.0.1 or localhost, or set MAQUETTE_AUTHENTICATION=keys.",
                field="Host",
            )
        origin = request.headers.get("origin")
        if request.method in HARMLESS or origin is None or origin in self._allowed_origins:
            return None
        if _split(origin).netloc == host:
            return None
        return problem(
            "forbidden",
            code="origin-not-allowed",
            detail="A page of another origin asked for a change.",
            remedy="Name its origin in MAQUETTE_CORS_ORIGINS if it is yours.",
            field="Origin",
        )


def _split(address: str) -> SplitResult:
    """Split an address; one that is invalid, say with an unclosed bracket, has no parts."""
    try:
        return urlsplit(address)
    except ValueError:
        return urlsplit("")
