"""Our server in this process, its limits the test's own, and callers that send as they like.

The application does what the test tells it to. What is late is so by a limit that is short; what is
not has hours. That a limit is over is known by another body that it has ended.
"""

import contextlib
import http.client
import socket
import threading
from collections.abc import AsyncIterator, Iterator
from dataclasses import dataclass, field
from typing import Any

from anyio import to_thread
from fastapi import FastAPI, Request
from fastapi.responses import PlainTextResponse, Response, StreamingResponse
from starlette.requests import ClientDisconnect

from api_schemas.problems import PROBLEM_MEDIA_TYPE, Problem
from service.api.app import ApiServer
from service.api.limits import BodyLimits, RequestLimit
from service.api.problems import install_problem_handlers
from tests.integration.service.harness import PATIENCE_S, eventually

LONG_S = 3600.0
LARGE_BYTES = 50_000_000
"""More than the buffers of both ends hold."""

HEAD = "{method} {path} HTTP/1.1\r\nHost: 127.0.0.1\r\n"


@dataclass
class Served:
    """A server, and what holds its application up."""

    server: ApiServer
    port: int
    entered: threading.Semaphore
    """One for each request to /held that began."""
    released: threading.Event = field(default_factory=threading.Event)

    @property
    def connections(self) -> list[Any]:
        return list(self.server.server_state.connections)

    def has_connections(self, number: int) -> None:
        eventually(lambda: len(self.connections) == number, what=f"{number} connections")


def application(
    entered: threading.Semaphore,
    released: threading.Event,
    *,
    most: int,
    body_s: float,
    bytes_per_s: int,
) -> FastAPI:
    async def quick(_: Request) -> Response:
        return PlainTextResponse("quick")

    async def held(_: Request) -> Response:
        entered.release()
        await to_thread.run_sync(released.wait)
        return PlainTextResponse("held")

    async def length(request: Request) -> Response:
        try:
            return PlainTextResponse(str(len(await request.body())))
        except ClientDisconnect:
            return PlainTextResponse("for nobody")

    async def large(_: Request) -> Response:
        return Response(bytes(LARGE_BYTES))

    async def stream(_: Request) -> Response:
        async def events() -> AsyncIterator[str]:
            yield "first\n"
            await to_thread.run_sync(released.wait)
            yield "second\n"

        return StreamingResponse(events(), media_type="text/event-stream")

    app = FastAPI()
    install_problem_handlers(app)
    app.add_middleware(BodyLimits, max_bytes=10**9, time_limit_s=body_s, bytes_per_s=bytes_per_s)
    app.add_middleware(RequestLimit, most=most)
    for resource in (quick, held, length, large, stream):
        path = f"/{resource.__name__}"
        app.add_route(path, resource, methods=["GET", "POST"])
    return app


@contextlib.contextmanager
def serving(
    *,
    most: int = 1_000,
    body_s: float = LONG_S,
    bytes_per_s: int = 10**9,
) -> Iterator[Served]:
    """Serve in a thread; the ends of answers are watched by the test, not by time."""
    entered, released = threading.Semaphore(0), threading.Event()
    server = ApiServer(
        application(entered, released, most=most, body_s=body_s, bytes_per_s=bytes_per_s),
        log_level="WARNING",
        draining=threading.Event(),
        stop_delay_s=0.0,
    )
    server.config.timeout_keep_alive = int(LONG_S)
    listener = socket.create_server(("127.0.0.1", 0))
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
    thread.start()
    try:
        eventually(lambda: server.started, what="serving")
        yield Served(server, listener.getsockname()[1], entered, released)
    finally:
        released.set()
        server.should_exit = True
        thread.join()


class Caller:
    """A connection of a client that sends and reads as it likes."""

    def __init__(self, port: int) -> None:
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=PATIENCE_S)

    def __enter__(self) -> "Caller":
        return self

    def __exit__(self, *_: object) -> None:
        self.socket.close()

    def send(self, text: str | bytes) -> None:
        self.socket.sendall(text if isinstance(text, bytes) else text.encode())

    def ask(self, path: str, *, method: str = "GET", headers: str = "") -> None:
        self.send(HEAD.format(method=method, path=path) + headers + "\r\n")

    def answer(self) -> tuple[http.client.HTTPResponse, bytes]:
        answer = http.client.HTTPResponse(self.socket)
        answer.begin()
        return answer, answer.read()

    def followed(self, path: str) -> http.client.HTTPResponse:
        """Follow a stream, and return when it has begun."""
        self.ask(path)
        stream = http.client.HTTPResponse(self.socket)
        stream.begin()
        assert stream.readline()
        return stream

    def status(self) -> int:
        return self.answer()[0].status

    def read(self, size: int) -> bytes:
        content = bytearray()
        while len(content) < size and (part := self.socket.recv(size - len(content))):
            content += part
        return bytes(content)

    def is_ended(self) -> bool:
        """Wait for the connection's end, which nothing may precede."""
        return self.socket.recv(1) == b""

    def problem(self, status: int) -> Problem:
        """Read a problem."""
        answer, body = self.answer()
        assert answer.status == status
        assert answer.headers["content-type"] == PROBLEM_MEDIA_TYPE
        return Problem.model_validate_json(body)
