"""Middleware: limits of requests and bodies, what is observed, HEAD."""

import asyncio
import json
import logging
from collections.abc import AsyncIterator, Awaitable, Callable
from types import SimpleNamespace
from typing import Any
from unittest.mock import create_autospec

import pytest
from starlette.requests import ClientDisconnect
from starlette.responses import PlainTextResponse, StreamingResponse
from starlette.types import Message, Receive, Scope, Send

from service.api.auth import Authentication
from service.api.limits import BodyLimits, RateLimit, RequestLimit
from service.api.observation import HeadAsGet, Observation, ServiceMetrics
from service.api.problems import ProblemError
from service.jobs.engine import JobEngine
from service.jobs.keys import ApiKey, hash_key
from service.process.data_folder import Disk

LIMIT_S = 0.2
FOREVER_S = 600.0
PIECE = 1000
OVERDUE_S = 2 * LIMIT_S


async def in_time(piece: bytes = bytes(PIECE), *, more: bool = True) -> Message:
    return {"type": "http.request", "body": piece, "more_body": more}


async def overdue(piece: bytes = bytes(PIECE), *, more: bool = True) -> Message:
    await asyncio.sleep(OVERDUE_S)
    return await in_time(piece, more=more)


async def never() -> Message:
    await asyncio.sleep(FOREVER_S)
    raise AssertionError


async def reads_all(scope: Scope, receive: Receive, send: Send) -> None:
    length = 0
    while True:
        message = await receive()
        length += len(message.get("body", b""))
        if not message.get("more_body", False):
            await say(send, str(length))
            return


async def say(send: Send, text: str, *, status: int = 200) -> None:
    await send({"type": "http.response.start", "status": status, "headers": []})
    await send({"type": "http.response.body", "body": text.encode()})


def answered(
    *parts: Callable[[], Awaitable[Message]],
    application: Callable[[Scope, Receive, Send], Awaitable[None]] = reads_all,
    bytes_per_s: int = 10**9,
    headers: tuple[tuple[bytes, bytes], ...] = ((b"content-length", b"99999"),),
) -> list[Message]:
    """What is sent to a client whose body comes in these parts."""
    sent: list[Message] = []
    coming = iter(parts)

    async def receive() -> Message:
        return await next(coming)()

    async def send(message: Message) -> None:
        sent.append(message)

    scope: dict[str, Any] = {
        "type": "http",
        "method": "POST",
        "path": "/v1/images",
        "query_string": b"",
        "headers": list(headers),
    }
    limited = BodyLimits(
        application, max_bytes=10**9, time_limit_s=LIMIT_S, bytes_per_s=bytes_per_s
    )
    asyncio.run(limited(scope, receive, send))
    return sent


def last() -> Awaitable[Message]:
    return in_time(b"", more=False)


def assert_is_late(sent: list[Message]) -> None:
    start, body = sent
    assert start["status"] == 408
    assert (b"connection", b"close") in start["headers"]
    told = json.loads(body["body"])
    assert (told["type"], told["code"]) == ("/problems/request-timeout", "body-too-slow")
    assert told["instance"] == "/v1/images"


def test_a_body_that_does_not_come_is_late():
    assert_is_late(answered(never))
    assert_is_late(answered(in_time, never))
    assert_is_late(answered(never, headers=((b"transfer-encoding", b"chunked"),)))


def test_times_of_waiting_add_up():
    async def a_little() -> Message:
        await asyncio.sleep(0.6 * LIMIT_S)
        return await in_time(b"x")

    assert_is_late(answered(*[a_little] * 10))


def test_a_body_at_a_fair_rate_may_take_longer_than_the_limit():
    # Each piece is worth ten seconds.
    sent = answered(in_time, overdue, overdue, overdue, last, bytes_per_s=PIECE // 10)
    assert sent[1]["body"] == str(4 * PIECE).encode()


def test_time_in_which_nobody_asked_does_not_count():
    async def reads_slowly(scope: Scope, receive: Receive, send: Send) -> None:
        for _ in range(3):
            await asyncio.sleep(OVERDUE_S)
            await receive()
        await say(send, "read")

    sent = answered(in_time, in_time, last, application=reads_slowly)
    assert sent[0]["status"] == 200


def test_the_end_of_the_connection_is_waited_for_without_limit():
    async def waits_for_the_end(scope: Scope, receive: Receive, send: Send) -> None:
        await receive()
        assert (await receive())["type"] == "http.disconnect"
        await say(send, "stream")

    async def hangs_up() -> Message:
        await asyncio.sleep(OVERDUE_S)
        return {"type": "http.disconnect"}

    whole = answered(last, hangs_up, application=waits_for_the_end)
    assert whole[0]["status"] == 200
    none = answered(last, hangs_up, application=waits_for_the_end, headers=())
    assert none[0]["status"] == 200


def test_an_answer_that_has_begun_is_not_cut_short_for_its_body():
    async def streams(scope: Scope, receive: Receive, send: Send) -> None:
        waiting = asyncio.create_task(receive())
        await asyncio.sleep(0)
        await send({"type": "http.response.start", "status": 200, "headers": []})
        await waiting
        await send({"type": "http.response.body", "body": b"whole"})

    sent = answered(never, last, application=streams)
    assert [message.get("body") for message in sent] == [None, b"whole"]


def test_what_throws_the_body_away_before_it_answers_is_heard_no_more():
    async def refuses(scope: Scope, receive: Receive, send: Send) -> None:
        while (await receive()).get("more_body"):
            pass
        await say(send, "403")

    assert_is_late(answered(in_time, never, application=refuses))


def test_an_application_that_answers_the_lateness_itself_reads_no_more():
    async def handles(scope: Scope, receive: Receive, send: Send) -> None:
        with pytest.raises(ProblemError) as caught:
            await receive()
        assert (await receive())["type"] == "http.disconnect"
        await say(send, caught.value.problem.code, status=408)

    assert answered(never, application=handles)[1]["body"] == b"body-too-slow"


def test_what_else_was_to_be_said_of_half_a_body_is_not():
    async def has_an_answer_already(scope: Scope, receive: Receive, send: Send) -> None:
        with pytest.raises(ProblemError):
            await receive()
        await say(send, "another kind of content", status=415)

    assert_is_late(answered(never, application=has_an_answer_already))


def test_another_problem_is_not_taken_for_lateness():
    async def fails(scope: Scope, receive: Receive, send: Send) -> None:
        await receive()
        raise ValueError

    with pytest.raises(ValueError):  # noqa: PT011
        answered(in_time, application=fails)


KEY = "0123abcd"


class Clock:
    """A clock that is set by hand."""

    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


def test_a_burst_passes_and_the_next_request_is_told_when():
    limit = RateLimit(per_minute=30, monotonic=Clock())
    assert [limit.take(KEY) for _ in range(31)] == [0] * 30 + [2]


def test_requests_pass_at_the_rate():
    clock = Clock()
    limit = RateLimit(per_minute=30, monotonic=clock)
    for _ in range(30):
        limit.take(KEY)
    clock.now += 1.5
    assert limit.take(KEY) == 1
    clock.now += 0.5
    assert [limit.take(KEY), limit.take(KEY)] == [0, 2]


def test_a_bucket_does_not_overflow():
    clock = Clock()
    limit = RateLimit(per_minute=30, monotonic=clock)
    limit.take(KEY)
    clock.now += 3_600.0
    assert [limit.take(KEY) for _ in range(31)].count(0) == 30


def test_keys_do_not_share_a_bucket():
    limit = RateLimit(per_minute=1, monotonic=Clock())
    assert [limit.take(KEY), limit.take("other"), limit.take(KEY)] == [0, 0, 60]


def api_key(name: str, *, revoked_at: float | None = None) -> ApiKey:
    return ApiKey(
        id=name, tenant="a", secret_hash=hash_key(name), created_at=0.0, revoked_at=revoked_at
    )


def test_each_key_has_requests_of_its_own_and_a_revoked_one_has_none():
    keys: Any = SimpleNamespace(all_keys=lambda: [*map(api_key, ("one", "two")), old])
    old = api_key("old", revoked_at=1.0)
    guarded = Authentication(reads_all, keys=keys, rate_limit=RateLimit(per_minute=1))
    sent: list[Message] = []

    async def send(message: Message) -> None:
        sent.append(message)

    def asked(key: str) -> int:
        headers = [(b"authorization", f"Bearer {key}".encode())]
        scope = {"type": "http", "method": "GET", "path": "/v1/fits", "query_string": b""}
        sent.clear()
        asyncio.run(guarded(scope | {"headers": headers}, last, send))
        return sent[0]["status"]

    assert [asked(key) for key in ("one", "two", "one", "old", "none")] == [200, 200, 429, 401, 401]


@pytest.mark.parametrize(
    ("path", "status"),
    [("/healthz/live", 200), ("/healthz/ready", 200), ("/metrics", 200), ("/v1/fits", 503)],
)
def test_probes_are_answered_by_a_service_that_is_full(path: str, status: int):
    sent: list[Message] = []

    async def send(message: Message) -> None:
        sent.append(message)

    scope = {"type": "http", "method": "GET", "path": path, "query_string": b"", "headers": []}
    asyncio.run(RequestLimit(reads_all, most=0)(scope, last, send))
    assert sent[0]["status"] == status


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
