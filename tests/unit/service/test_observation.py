"""What is said of requests that end otherwise than by an answer of the application."""

import asyncio
import logging
from collections.abc import AsyncIterator
from unittest.mock import create_autospec

import pytest
from starlette.requests import ClientDisconnect
from starlette.responses import PlainTextResponse, StreamingResponse
from starlette.types import Message, Receive, Scope, Send

from service.api.observation import HeadAsGet, Observation, ServiceMetrics
from service.jobs.engine import JobEngine
from service.process.data_folder import Disk

SCOPE = {
    "type": "http",
    "method": "POST",
    "path": "/v1/initial-poses",
    "query_string": b"",
    "headers": [],
    "state": {},
}


async def nothing() -> Message:
    return {"type": "http.disconnect"}


def answers(error: Exception) -> list[Message]:
    """What is sent when the application ends with an error."""
    sent: list[Message] = []

    async def application(scope: Scope, receive: Receive, send: Send) -> None:
        raise error

    async def send(message: Message) -> None:
        sent.append(message)

    observed = Observation(
        application, metrics=ServiceMetrics(create_autospec(JobEngine), Disk(None, reserve_bytes=0))
    )
    asyncio.run(observed(dict(SCOPE), nothing, send))
    return sent


def test_who_hangs_up_while_sending_is_no_fault_of_the_service(caplog: pytest.LogCaptureFixture):
    with caplog.at_level(logging.DEBUG, logger="service.api.observation"):
        assert answers(ClientDisconnect()) == []
    (line,) = caplog.records
    assert line.levelno == logging.INFO
    assert line.exc_info is None
    assert "499" in str(vars(line))


def test_a_fault_is_logged_and_answered(caplog: pytest.LogCaptureFixture):
    sent = answers(ValueError("a fault"))
    assert sent[0]["status"] == 500
    assert any(record.exc_info for record in caplog.records)


def test_head_is_get_without_the_body_and_ends_a_stream():
    read: list[bytes] = []

    async def endless() -> AsyncIterator[bytes]:
        while True:
            read.append(b"event")
            yield read[-1]
            await asyncio.sleep(0)

    async def application(scope: Scope, receive: Receive, send: Send) -> None:
        assert scope["method"] == "GET"
        whole = PlainTextResponse("an answer", headers={"ETag": "1"})
        await (whole if scope["path"] == "/whole" else StreamingResponse(endless()))(
            scope, receive, send
        )

    def headed(path: str) -> list[Message]:
        sent: list[Message] = []

        async def waits() -> Message:
            await asyncio.Event().wait()
            raise AssertionError

        async def send(message: Message) -> None:
            sent.append(message)

        scope = SCOPE | {"method": "HEAD", "path": path}
        asyncio.run(asyncio.wait_for(HeadAsGet(application)(scope, waits, send), 600.0))
        return sent

    for path in ("/whole", "/stream"):
        start, body = headed(path)
        assert (start["status"], body) == (200, {"type": "http.response.body", "body": b""})
        assert ((b"content-length", b"9") in start["headers"]) is (path == "/whole")
    assert len(read) == 1
