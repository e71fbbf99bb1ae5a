"""The last response on a connection, sent where no application answers."""

import asyncio
from collections.abc import Sequence
from http import HTTPStatus
from typing import Final

import h11

from api_schemas.problems import PROBLEM_MEDIA_TYPE, Problem
from service.api.problems import retry_header
from service.api.security_headers import ALWAYS, UNLESS_SAID

Headers = Sequence[tuple[bytes, bytes]]

CLOSE: Final = {"Connection": "close"}


def raw_answer(reason: Problem, default_headers: Headers = ()) -> bytes:
    """Write a problem as HTTP/1.1, with the headers that all responses have."""
    body = reason.model_dump_json().encode()
    named = {
        "Content-Type": PROBLEM_MEDIA_TYPE,
        "Content-Length": str(len(body)),
        **retry_header(reason),
        **CLOSE,
        **ALWAYS,
        **UNLESS_SAID,
    }
    written = h11.Connection(h11.SERVER)
    parts = (
        h11.Response(
            status_code=reason.status,
            reason=HTTPStatus(reason.status).phrase.encode(),
            headers=[
                *default_headers,
                *((name.lower().encode(), value.encode()) for name, value in named.items()),
            ],
        ),
        h11.Data(data=body),
        h11.EndOfMessage(),
    )
    return b"".join(written.send(part) or b"" for part in parts)


class Farewell(asyncio.Protocol):
    """A connection that gets a last answer, and is closed once that is read or time is up.

    If closed at once, it would be reset by whatever the client is still sending, and the reset may
    make the client lose the answer. It is in ``others`` as long as it is open.
    """

    def __init__(
        self, transport: asyncio.Transport, others: "set[Farewell]", *, time_limit_s: float
    ) -> None:
        self._transport = transport
        self._others = others
        self._timer = asyncio.get_running_loop().call_later(time_limit_s, transport.abort)
        others.add(self)

    def say(self, answer: bytes) -> None:
        """Write the answer and the end of the stream."""
        self._transport.write(answer)
        self._transport.write_eof()
        if not self._transport.is_reading():
            self._transport.resume_reading()

    def data_received(self, data: bytes) -> None:
        """Discard what still comes."""

    def connection_lost(self, exc: Exception | None) -> None:
        """Stop the timer, and no longer count as open."""
        self._timer.cancel()
        self._others.discard(self)
