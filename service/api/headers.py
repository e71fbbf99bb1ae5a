"""Headers of every answer: what browsers may do with it; and which answers are compressed."""

from collections.abc import Mapping
from typing import Final

from starlette.datastructures import MutableHeaders
from starlette.middleware.gzip import DEFAULT_EXCLUDED_CONTENT_TYPES
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.api.files import GLB, MESH_FORMATS

NOTHING: Final = "default-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
"""The policy of responses that are not pages: in a browser they may load and run nothing."""

OWN_FILES: Final = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
    "font-src 'self'; connect-src 'self'; worker-src 'self'; manifest-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
"""The policy of our own pages: files of this service alone, nothing inline, no framing."""

STATIC_SITE: Final = f"{OWN_FILES}; style-src-attr 'unsafe-inline'"
"""The policy of pages of a generator that writes widths into their elements."""

OWN_CAMERA: Final = (
    "accelerometer=(self), camera=(self), gyroscope=(self), geolocation=(), microphone=()"
)
"""The permissions of the page that takes pictures; its level needs the two sensors."""

ALWAYS: Final[Mapping[str, str]] = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
}

UNLESS_SAID: Final[Mapping[str, str]] = {
    "Content-Security-Policy": NOTHING,
    "Permissions-Policy": (
        "accelerometer=(), camera=(), gyroscope=(), geolocation=(), microphone=()"
    ),
    # Responses belong to their caller, and what is erased must not live on in a browser's cache:
    # with an ETag alone it would, until it is asked for again.
    "Cache-Control": "no-store",
    "Cross-Origin-Resource-Policy": "same-origin",
}

COMPRESSED_FROM_BYTES: Final = 1_000
LEFT_AS_THEY_ARE: Final = (
    *DEFAULT_EXCLUDED_CONTENT_TYPES,
    "application/octet-stream",
    "image/*",
    GLB,
    MESH_FORMATS["stl"],
)
"""Event streams, and what is compressed already or, as floating-point numbers are, hardly gets
smaller."""


class SecurityHeaders:
    """ASGI middleware: adds the headers to every answer."""

    def __init__(self, app: ASGIApp, *, cross_origin: bool) -> None:
        self._app = app
        self._unless_said = dict(UNLESS_SAID)
        if cross_origin:
            # CORS decides which origins those are.
            self._unless_said["Cross-Origin-Resource-Policy"] = "cross-origin"

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on and complete the response."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return

        async def completed(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in ALWAYS.items():
                    headers[name] = value
                for name, value in self._unless_said.items():
                    headers.setdefault(name, value)
            await send(message)

        await self._app(scope, receive, completed)
