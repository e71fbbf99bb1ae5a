"""Bodies that take too long, by real sockets."""

import socket
import threading

import pytest

from service.api import app
from tests.integration.service.harness import PATIENCE_S, eventually
from tests.integration.service.limited_server import (
    FAIR_S,
    HEAD,
    LARGE_BYTES,
    SHORT_S,
    Caller,
    let_a_body_be_late,
    serving,
)

pytestmark = pytest.mark.usefixtures("no_fault_is_logged")


def test_an_answer_that_takes_long_is_waited_for():
    with serving(body_s=SHORT_S) as served, Caller(served.port) as patient:
        patient.ask("/held", method="POST", headers="Content-Length: 2\r\n")
        patient.send("{}")
        assert served.entered.acquire(timeout=PATIENCE_S)
        let_a_body_be_late(served)
        let_a_body_be_late(served)
        served.released.set()
        assert patient.status() == 200


def test_a_stream_of_events_outlives_the_limits():
    with serving(body_s=SHORT_S) as served, Caller(served.port) as follower:
        stream = follower.followed("/stream")
        let_a_body_be_late(served)
        let_a_body_be_late(served)
        served.released.set()
        assert stream.read() == b"second\n"


@pytest.mark.parametrize("framing", ["Content-Length: 1000\r\n", "Transfer-Encoding: chunked\r\n"])
def test_a_body_that_does_not_end_is_answered_408(framing: str):
    with serving(body_s=SHORT_S) as served, Caller(served.port) as slow:
        slow.ask("/length", method="POST", headers=framing)
        slow.send("5\r\nabc")
        told = slow.problem(408)
        assert (told.type, told.code) == ("/problems/request-timeout", "body-too-slow")
        assert slow.is_ended()
        served.has_connections(0)


def test_a_body_at_a_fair_rate_may_take_longer_than_the_limit():
    # Its first piece gives it hours.
    serve = serving(body_s=SHORT_S, bytes_per_s=1)
    with serve as served, Caller(served.port) as fair:
        head = HEAD.format(method="POST", path="/length") + "Content-Length: 30000\r\n\r\n"
        for piece in (head.encode() + bytes(10_000), bytes(10_000), bytes(10_000)):
            fair.send(piece)
            let_a_body_be_late(served)
        assert fair.answer()[1] == b"30000"


def test_a_body_that_the_service_does_not_read_is_not_late():
    size = 200_000
    with serving(body_s=FAIR_S) as served, Caller(served.port) as sender:
        sender.ask("/held-length", method="POST", headers=f"Content-Length: {size}\r\n")
        sending = threading.Thread(target=sender.send, args=[bytes(size)])
        sending.start()
        assert served.entered.acquire(timeout=PATIENCE_S)
        eventually(
            lambda: any(each.flow and each.flow.read_paused for each in served.connections),
            what="reading paused",
        )
        let_a_body_be_late(served)
        served.released.set()
        assert sender.answer()[1] == str(size).encode()
        sending.join()


def test_a_client_that_waits_to_be_asked_for_its_body_is_not_late():
    with serving(body_s=FAIR_S) as served, Caller(served.port) as polite:
        headers = "Content-Length: 3\r\nExpect: 100-continue\r\n"
        polite.ask("/held-length", method="POST", headers=headers)
        assert served.entered.acquire(timeout=PATIENCE_S)
        let_a_body_be_late(served)
        served.released.set()
        asked = b"HTTP/1.1 100 Continue\r\n\r\n"
        assert polite.read(len(asked)) == asked
        polite.send("abc")
        assert polite.answer()[1] == b"3"


def test_a_body_that_ends_after_its_answer_keeps_the_connection():
    with serving() as served, Caller(served.port) as late:
        late.ask("/quick", method="POST", headers="Content-Length: 4\r\n")
        assert late.status() == 200
        late.send("some")
        late.ask("/quick")
        assert late.status() == 200


@pytest.mark.skipif(not hasattr(socket, "TCP_USER_TIMEOUT"), reason="Linux has it")
def test_who_does_not_read_is_not_written_to_for_ever(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(app, "UNREAD_S", 1)
    with serving() as served, Caller(served.port) as idle, Caller(served.port) as reader:
        idle.ask("/large")
        reader.ask("/large")
        answer, content = reader.answer()
        assert (answer.status, len(content)) == (200, LARGE_BYTES)
        served.has_connections(1)
