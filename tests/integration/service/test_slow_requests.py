"""Heads and bodies that take too long, by real sockets."""

import contextlib
import threading

import pytest

from tests.integration.service.harness import PATIENCE_S, eventually
from tests.integration.service.limited_server import (
    FAIR_S,
    HEAD,
    SHORT_S,
    Caller,
    let_a_head_be_late,
    let_pass,
    serving,
)

pytestmark = pytest.mark.usefixtures("no_fault_is_logged")


def test_a_head_that_does_not_end_is_answered_408():
    with serving(head_s=SHORT_S) as served, Caller(served.port) as slow:
        slow.send("GET /quick HTTP/1.1\r\nHo")
        told = slow.problem(408)
        assert (told.type, told.code) == ("/problems/request-timeout", "head-too-slow")
        served.has_connections(0)


def test_a_head_that_comes_byte_by_byte_is_answered_408():
    with serving(head_s=SHORT_S) as served, Caller(served.port) as slow:
        slow.send("GET /quick HTTP/1.1\r\n")
        slow.socket.settimeout(SHORT_S / 20)
        early = b""
        while not early:
            slow.send("X-A: b\r\n")
            with contextlib.suppress(TimeoutError):
                early = slow.socket.recv(100_000)
        assert early.startswith(b"HTTP/1.1 408 Request Timeout\r\n")


def test_the_next_head_has_the_same_time():
    with serving(head_s=SHORT_S) as served, Caller(served.port) as slow:
        slow.ask("/quick")
        assert slow.status() == 200
        slow.send("GET /quick")
        assert slow.problem(408).code == "head-too-slow"


def test_a_head_begun_behind_another_request_has_the_same_time():
    with serving(head_s=SHORT_S) as served, Caller(served.port) as slow:
        slow.ask("/held", headers="\r\nGET /quick")
        assert served.entered.acquire(timeout=PATIENCE_S)
        served.released.set()
        assert slow.status() == 200
        assert slow.problem(408).code == "head-too-slow"


def test_who_asks_nothing_at_all_is_told_nothing():
    with serving(head_s=SHORT_S) as served, Caller(served.port) as silent:
        assert silent.is_ended()


def test_a_connection_between_requests_has_no_head_to_send():
    with serving(head_s=SHORT_S) as served, Caller(served.port) as idle:
        idle.ask("/quick")
        assert idle.status() == 200
        let_a_head_be_late(served)
        let_a_head_be_late(served)
        idle.ask("/quick")
        assert idle.status() == 200


def test_what_is_no_http_is_told_so_by_a_problem():
    with serving() as served, Caller(served.port) as stranger:
        stranger.send("Good morning!\r\n\r\n")
        assert stranger.problem(400).code == "not-http"


def test_an_answer_that_takes_long_is_waited_for():
    with serving(head_s=SHORT_S, body_s=SHORT_S) as served, Caller(served.port) as patient:
        patient.ask("/held", method="POST", headers="Content-Length: 2\r\n")
        patient.send("{}")
        assert served.entered.acquire(timeout=PATIENCE_S)
        let_a_head_be_late(served)
        let_a_head_be_late(served)
        served.released.set()
        assert patient.status() == 200


def test_a_stream_of_events_outlives_the_limits():
    with serving(head_s=SHORT_S, body_s=SHORT_S) as served, Caller(served.port) as follower:
        stream = follower.followed("/stream")
        let_a_head_be_late(served)
        let_a_head_be_late(served)
        served.released.set()
        assert stream.read() == b"second\n"


@pytest.mark.parametrize("framing", ["Content-Length: 1000\r\n", "Transfer-Encoding: chunked\r\n"])
def test_a_body_that_does_not_end_is_answered_408(framing: str):
    with serving(body_s=SHORT_S) as served, Caller(served.port) as slow:
        slow.ask("/length", method="POST", headers=framing)
        slow.send("5\r\nabc")
        told = slow.problem(408)
        assert (told.type, told.code) == ("/problems/request-timeout", "body-too-slow")
        served.has_connections(0)


def test_a_body_at_a_fair_rate_may_take_longer_than_the_limit():
    # Its first piece gives it hours.
    serve = serving(head_s=SHORT_S, body_s=SHORT_S, bytes_per_s=1)
    with serve as served, Caller(served.port) as fair:
        head = HEAD.format(method="POST", path="/length") + "Content-Length: 30000\r\n\r\n"
        for piece in (head.encode() + bytes(10_000), bytes(10_000), bytes(10_000)):
            fair.send(piece)
            let_a_head_be_late(served)
        assert fair.answer()[1] == b"30000"


def test_a_body_that_the_service_does_not_read_is_not_late():
    size = 200_000
    with serving(head_s=SHORT_S, body_s=FAIR_S) as served, Caller(served.port) as sender:
        sender.ask("/held-length", method="POST", headers=f"Content-Length: {size}\r\n")
        sending = threading.Thread(target=sender.send, args=[bytes(size)])
        sending.start()
        assert served.entered.acquire(timeout=PATIENCE_S)
        eventually(
            lambda: any(each.flow and each.flow.read_paused for each in served.connections),
            what="reading paused",
        )
        let_pass(served, FAIR_S)
        served.released.set()
        assert sender.answer()[1] == str(size).encode()
        sending.join()


def test_a_client_that_waits_to_be_asked_for_its_body_is_not_late():
    with serving(head_s=SHORT_S, body_s=FAIR_S) as served, Caller(served.port) as polite:
        headers = "Content-Length: 3\r\nExpect: 100-continue\r\n"
        polite.ask("/held-length", method="POST", headers=headers)
        assert served.entered.acquire(timeout=PATIENCE_S)
        let_pass(served, FAIR_S)
        served.released.set()
        asked = b"HTTP/1.1 100 Continue\r\n\r\n"
        assert polite.read(len(asked)) == asked
        polite.send("abc")
        assert polite.answer()[1] == b"3"


def test_what_is_left_of_a_body_once_it_is_answered_has_its_time_too():
    with serving(body_s=SHORT_S) as served, Caller(served.port) as slow:
        slow.ask("/quick", method="POST", headers="Content-Length: 1000\r\n")
        slow.send("some")
        assert slow.status() == 200
        assert slow.is_ended()


def test_a_body_that_ends_after_its_answer_keeps_the_connection():
    with serving() as served, Caller(served.port) as late:
        late.ask("/quick", method="POST", headers="Content-Length: 4\r\n")
        assert late.status() == 200
        late.send("some")
        late.ask("/quick")
        assert late.status() == 200
