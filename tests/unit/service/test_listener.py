"""Connections that a listener takes and those that it turns away."""

import asyncio
import contextlib
import resource
import socket
from collections.abc import Iterator

import pytest

from service.process.listener import KEPT_DESCRIPTORS, Listener, connection_limit, listen
from service.settings import Settings

MOST = 5


@pytest.fixture
def listener(monkeypatch: pytest.MonkeyPatch) -> Iterator[Listener]:
    monkeypatch.setattr("service.process.listener.LOOK_S", 0.0)
    with Listener(socket.AF_INET, most=MOST) as listener:
        listener.bind(("127.0.0.1", 0))
        listener.listen()
        yield listener


def connect(listener: Listener) -> socket.socket:
    return socket.create_connection(listener.getsockname(), timeout=10.0)


def test_too_many_connections_are_turned_away_until_others_close_and_told_once(listener, caplog):
    with contextlib.ExitStack() as stack:
        for _ in range(MOST):
            stack.enter_context(connect(listener)).sendall(b"GET / HT")
        served = [listener.accept()[0] for _ in range(MOST)]
        for _ in range(20):
            with connect(listener) as another:
                with pytest.raises(ConnectionAbortedError):
                    listener.accept()
                assert another.recv(1) == b""
        served.pop().close()
        stack.enter_context(connect(listener))
        served.append(listener.accept()[0])
        for each in served:
            each.close()
    assert [record.getMessage() for record in caplog.records] == [
        "5 connections are open: more are turned away."
    ]


async def answer(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    writer.write(await reader.readline())
    writer.close()
    await writer.wait_closed()


def test_asyncio_serves_one_connection_after_the_other(listener, caplog):
    async def course() -> None:
        async with await asyncio.start_server(answer, sock=listener):
            for _ in range(4 * MOST):
                reader, writer = await asyncio.open_connection(*listener.getsockname())
                writer.write(b"hello\n")
                assert await reader.read() == b"hello\n"
                writer.close()
                await writer.wait_closed()

    asyncio.run(course())
    assert not caplog.records


@pytest.mark.parametrize(
    ("descriptors", "limit"), [(100, 50), (1_024, 1_024 - KEPT_DESCRIPTORS), (1_048_576, 10_000)]
)
def test_connections_leave_descriptors_for_everything_else(descriptors: int, limit: int):
    assert connection_limit(descriptors) == limit


def test_listening_raises_the_soft_limit_of_descriptors_to_the_hard_one():
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(soft, 512), hard))
    try:
        listen(Settings(port=0)).close()
        assert resource.getrlimit(resource.RLIMIT_NOFILE) == (hard, hard)
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
