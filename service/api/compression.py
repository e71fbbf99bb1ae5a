"""Answers are compressed for callers who say that they can read it (RFC 9110 12.5.3)."""

from typing import Final

from starlette.datastructures import MutableHeaders
from starlette.middleware.gzip import DEFAULT_EXCLUDED_CONTENT_TYPES, GZipMiddleware
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.representation.formats import GLB, STL

LEAST_BYTES: Final = 1_000
LEVEL: Final = 6
LEFT_AS_THEY_ARE: Final = (
    *DEFAULT_EXCLUDED_CONTENT_TYPES,
    "application/octet-stream",
    "application/pdf",
    "image/*",
    GLB,
    STL.media_type,
)
"""Event streams, and what is compressed already or, as floating-point numbers are, hardly gets
smaller."""


class Compression:
    """ASGI middleware: Starlette's gzip, with entity tags that say so.

    A compressed answer has other bytes than the file, to which no part of the file may be put: its
    tag becomes a weak one, which `If-Range` does not accept.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._compressing = GZipMiddleware(
            app, LEAST_BYTES, LEVEL, exclude_content_types=LEFT_AS_THEY_ARE
        )

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on and compress the response."""

        async def told(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                tag = headers.get("ETag", "")
                if "Content-Encoding" in headers and tag.startswith('"'):
                    headers["ETag"] = f"W/{tag}"
            await send(message)

        await self._compressing(scope, receive, told)
