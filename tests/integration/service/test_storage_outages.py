"""An object storage that is away: callers are told at once, jobs wait for it."""

import asyncio
import contextlib
import threading
from collections.abc import Callable, Iterator
from enum import StrEnum
from pathlib import Path
from urllib.parse import urlsplit

import pytest

from tests.integration.service.harness import (
    Machine,
    Service,
    eventually,
    is_running,
    pids_noted,
    running_service,
)
from tests.object_storage import ObjectStorage

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


JSON = "application/problem+json"


@pytest.fixture
def storage(storage: ObjectStorage) -> ObjectStorage:
    """One whose bucket is there."""
    place = {"LocationConstraint": storage.settings["aws_default_region"]}
    storage.client.create_bucket(Bucket=storage.bucket, CreateBucketConfiguration=place)
    return storage


@pytest.fixture
def door(storage: ObjectStorage) -> Iterator[StorageDoor]:
    with storage_door(storage.endpoint_url) as kept:
        yield kept


def test_a_storage_that_is_away_is_told_and_waited_for(
    storage: ObjectStorage, door: StorageDoor, tmp_path: Path
):
    behind = {**storage.settings, "aws_endpoint_url_s3": door.endpoint_url}
    with running_service(Machine(tmp_path / "data", settings=behind)) as service:
        for manner in (Manner.REFUSES, Manner.ANSWERS_503):
            folder = tmp_path / manner
            folder.mkdir()
            _is_told_and_waited_for(service, door, manner, folder)


def _is_told_and_waited_for(
    service: Service, door: StorageDoor, manner: Manner, folder: Path
) -> None:
    note, gate = folder / "pids", folder / "gate"
    ended = service.submit()
    service.ended(ended)
    running = service.submit({"gate": str(gate), "note_pid": str(note)})
    (pid,) = eventually(lambda: pids_noted(note), what="the fit runs")

    door.fail(manner)
    assert_refused_for_now(service, "POST", "/v1/fits")
    assert_refused_for_now(service, "GET", f"{ended}/result")
    assert_refused_for_now(service, "GET", "/healthz/ready")
    told = assert_refused_for_now(service, "DELETE", ended)
    assert "erased once that is back" in told
    assert service.client.get(ended).status_code == 404
    gate.touch()
    eventually(lambda: not is_running(pid), what="the fit is done")
    assert service.state(running) == "running"

    door.recover()
    job = service.ended(running)
    assert (job["state"], job["attempt"]) == ("succeeded", 1)
    assert service.client.get(f"{running}/result").status_code == 200


def assert_refused_for_now(service: Service, method: str, path: str) -> str:
    """Ask, and return what is told."""
    answer = service.post() if method == "POST" else service.client.request(method, path)
    assert answer.status_code == 503, answer.text
    assert answer.headers["content-type"] == JSON
    assert int(answer.headers["Retry-After"]) > 0
    assert answer.json()["code"] == "storage-unavailable"
    return answer.json()["detail"]
