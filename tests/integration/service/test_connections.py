"""More requests than there may be, bodies that take too long, by real sockets."""

import contextlib
import json
import socket

import pytest

from service.api import app
from tests.integration.service.harness import PATIENCE_S, Machine, eventually, running_service
from tests.integration.service.limited_server import (
    LARGE_BYTES,
    Caller,
    serving,
)

pytestmark = pytest.mark.usefixtures("no_fault_is_logged")


def test_one_more_than_may_be_is_refused_until_another_ends():
    with serving(most=2) as served, contextlib.ExitStack() as stack:
        busy = [stack.enter_context(Caller(served.port)) for _ in range(2)]
        for each in busy:
            each.ask("/held")
            assert served.entered.acquire(timeout=PATIENCE_S)
        with Caller(served.port) as further:
            for _ in range(3):
                further.ask("/quick")
                answer, body = further.answer()
                assert answer.status == 503
                assert int(answer.headers["retry-after"]) > 0
                assert json.loads(body)["type"] == "/problems/too-many-connections"
            served.released.set()
            assert [each.status() for each in busy] == [200, 200]
            further.ask("/quick")
            assert further.status() == 200


def test_an_event_stream_counts_as_long_as_it_is_followed():
    with serving(most=1) as served, Caller(served.port) as other:
        with Caller(served.port) as follower:
            follower.followed("/stream")
            other.ask("/quick")
            assert other.problem(503).code == "too-many-connections"
            served.released.set()

        def is_answered() -> bool:
            other.ask("/quick")
            return other.status() == 200

        eventually(is_answered, what="a place")


def test_who_sends_much_to_a_service_that_is_full_reads_why():
    with serving(most=1) as served, Caller(served.port) as busy:
        busy.ask("/held")
        assert served.entered.acquire(timeout=PATIENCE_S)
        with Caller(served.port) as sender:
            sender.ask("/length", method="POST", headers="Content-Length: 5000000\r\n")
            sender.send(bytes(5_000_000))
            assert sender.problem(503).code == "too-many-connections"


FORM = "Host: 127.0.0.1\r\nContent-Type: multipart/form-data; boundary=x\r\n"
REFUSED_KIND = "Host: 127.0.0.1\r\nContent-Type: text/plain\r\n"
REFUSED_HOST = "Host: elsewhere.example\r\nContent-Type: text/plain\r\n"


def test_the_service_itself_holds_to_its_settings(embedded: Machine):
    settings = {"body_time_limit_s": 1.0}
    machine = Machine(embedded.data_dir, settings=settings)
    with running_service(machine, api_only=True) as service, contextlib.ExitStack() as stack:
        port = service.client.base_url.port
        assert port is not None
        slow = [stack.enter_context(Caller(port)) for _ in range(3)]
        for body, headers in zip(slow, (FORM, REFUSED_KIND, REFUSED_HOST), strict=True):
            body.send(f"POST /v1/images HTTP/1.1\r\n{headers}Content-Length: 9\r\n\r\n")
        for body in slow:
            answer, content = body.answer()
            assert answer.status == 408
            assert answer.headers["x-request-id"]
            assert answer.headers["connection"] == "close"
            assert json.loads(content)["code"] == "body-too-slow"
            assert body.is_ended()


def test_a_body_that_ends_after_its_answer_keeps_the_connection():
    with serving() as served, Caller(served.port) as late:
        late.ask("/quick", method="POST", headers="Content-Length: 4\r\n")
        assert late.status() == 200
        late.send("some")
        late.ask("/quick")
        assert late.status() == 200


@pytest.mark.skipif(not hasattr(socket, "TCP_USER_TIMEOUT"), reason="Linux has it")
def test_who_does_not_read_is_not_written_to_for_ever(monkeypatch: pytest.MonkeyPatch):
    with monkeypatch.context() as impatience:
        impatience.setattr(app, "UNREAD_S", 1)
        with serving() as served, Caller(served.port) as idle:
            idle.ask("/large")
            asked = served.server.server_state
            eventually(lambda: asked.total_requests == 1, what="it is answered")
            served.has_connections(0)
    with serving() as served, Caller(served.port) as reader:
        reader.ask("/large")
        answer, content = reader.answer()
        assert (answer.status, len(content)) == (200, LARGE_BYTES)
