"""The door to an object storage: open, locked (connections refused), answering 503, or silent."""

import asyncio
import contextlib
import threading
from collections.abc import Callable, Iterator
from enum import StrEnum
from urllib.parse import urlsplit

BODY = b"<Error><Code>ServiceUnavailable</Code><Message>Reduce your request rate.</Message></Error>"
UNAVAILABLE = (
    b"HTTP/1.1 503 Service Unavailable\r\nContent-Type: application/xml\r\nConnection: close\r\n"
    b"Content-Length: %d\r\n\r\n%s" % (len(BODY), BODY)
)
READ_AT_ONCE = 65_536
READ_WITHIN_S = 1.0


class Manner(StrEnum):
    """How it fails."""

    REFUSES = "refuses"
    ANSWERS_503 = "answers 503"
    SAYS_NOTHING = "says nothing"


class StorageDoor:
    """Passes connections on to a server, unless it is told otherwise."""

    def __init__(self, endpoint_url: str) -> None:
        parsed = urlsplit(endpoint_url)
        self._behind = (parsed.hostname, parsed.port)
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever)
        self._server: asyncio.Server | None = None
        self._port = 0
        self._open: set[asyncio.StreamWriter] = set()
        self._manner: Manner | None = None

    @property
    def endpoint_url(self) -> str:
        """Where clients are to go."""
        return f"http://127.0.0.1:{self._port}"

    def fail(self, manner: Manner) -> None:
        """Break all connections, and fail from now on."""
        self._call(lambda: self._fail(manner))

    def recover(self) -> None:
        """Pass connections on again."""
        self._call(self._recover)

    def start(self) -> None:
        """Listen."""
        self._thread.start()
        self._call(self._recover)

    def stop(self) -> None:
        """Close everything."""
        self._call(lambda: self._fail(Manner.REFUSES))
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()

    def _call(self, what: Callable[[], object]) -> None:
        async def called() -> None:
            result = what()
            if asyncio.iscoroutine(result):
                await result

        asyncio.run_coroutine_threadsafe(called(), self._loop).result()

    async def _fail(self, manner: Manner) -> None:
        self._manner = manner
        if manner is Manner.REFUSES and self._server is not None:
            self._server.close()
            self._server = None
        for writer in list(self._open):
            writer.transport.abort()

    async def _recover(self) -> None:
        self._manner = None
        if self._server is None:
            self._server = await asyncio.start_server(self._serve, "127.0.0.1", self._port)
            self._port = self._server.sockets[0].getsockname()[1]

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._open.add(writer)
        try:
            if self._manner is Manner.ANSWERS_503:
                await _answer_unavailable(reader, writer)
            elif self._manner is Manner.SAYS_NOTHING:
                while await reader.read(READ_AT_ONCE):
                    pass
            else:
                await self._pass_on(reader, writer)
        except OSError:
            pass
        finally:
            self._open.discard(writer)
            writer.close()

    async def _pass_on(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        behind_reader, behind_writer = await asyncio.open_connection(*self._behind)
        self._open.add(behind_writer)
        try:
            await asyncio.gather(_copy(reader, behind_writer), _copy(behind_reader, writer))
        finally:
            self._open.discard(behind_writer)
            behind_writer.close()


async def _copy(source: asyncio.StreamReader, sink: asyncio.StreamWriter) -> None:
    while content := await source.read(READ_AT_ONCE):
        sink.write(content)
        await sink.drain()
    if sink.can_write_eof():
        sink.write_eof()


async def _answer_unavailable(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    # The request is read as far as it comes: a reset would hide the answer.
    with contextlib.suppress(TimeoutError):
        await asyncio.wait_for(reader.readuntil(b"\r\n\r\n"), READ_WITHIN_S)
    writer.write(UNAVAILABLE)
    await writer.drain()
    with contextlib.suppress(TimeoutError):
        while await asyncio.wait_for(reader.read(READ_AT_ONCE), READ_WITHIN_S):
            pass


@contextlib.contextmanager
def storage_door(endpoint_url: str) -> Iterator[StorageDoor]:
    """Keep a door while the context lasts."""
    door = StorageDoor(endpoint_url)
    door.start()
    try:
        yield door
    finally:
        door.stop()
