"""More connections than there may be, and the limits as the service is set up, by real sockets."""

import contextlib
import json
from typing import cast

import pytest

from service.api import connection_limits
from service.api.connection_limits import LimitedProtocol
from tests.integration.service.harness import PATIENCE_S, Machine, eventually, running_service
from tests.integration.service.limited_server import (
    LONG_S,
    SHORT_S,
    Caller,
    serving,
)

pytestmark = pytest.mark.usefixtures("no_fault_is_logged")


def test_one_more_than_may_be_is_refused_while_all_are_busy():
    with serving(max_connections=3) as served, contextlib.ExitStack() as stack:
        busy = [stack.enter_context(Caller(served.port)) for _ in range(2)]
        for each in busy:
            each.ask("/held")
            assert served.entered.acquire(timeout=PATIENCE_S)
        asking = stack.enter_context(Caller(served.port))
        asking.send("GET /quick")
        served.has_begun_heads(1)
        for _ in range(3):
            with Caller(served.port) as further:
                answer, body = further.answer()
                assert answer.status == 503
                assert int(answer.headers["retry-after"]) > 0
                assert json.loads(body)["type"] == "/problems/too-many-connections"
                assert further.is_ended()
        served.released.set()
        assert [each.status() for each in busy] == [200, 200]
        asking.send(" HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
        assert asking.status() == 200


def test_who_sends_much_to_a_service_that_is_full_reads_why():
    with serving(max_connections=1) as served, Caller(served.port) as busy:
        busy.ask("/held")
        assert served.entered.acquire(timeout=PATIENCE_S)
        with Caller(served.port) as sender:
            sender.ask("/length", method="POST", headers="Content-Length: 5000000\r\n")
            sender.send(bytes(5_000_000))
            assert sender.problem(503).code == "too-many-connections"


def test_when_too_many_are_being_refused_they_are_closed_at_once(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(connection_limits, "MOST_FAREWELLS", 0)
    with serving(max_connections=1) as served, Caller(served.port) as busy:
        busy.ask("/held")
        assert served.entered.acquire(timeout=PATIENCE_S)
        with Caller(served.port) as further:
            assert further.problem(503).code == "too-many-connections"


def test_a_refused_client_that_stays_is_cut_off(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(connection_limits, "FAREWELL_S", SHORT_S)
    with serving(max_connections=1) as served, Caller(served.port) as busy:
        busy.ask("/held")
        assert served.entered.acquire(timeout=PATIENCE_S)
        gate = cast("type[LimitedProtocol]", served.server.config.http_protocol_class).gate
        with Caller(served.port) as further:
            further.problem(503)
            eventually(lambda: not gate.farewells, what="cut off")


def test_the_connection_that_asks_nothing_for_longest_makes_room():
    with serving(max_connections=3) as served, contextlib.ExitStack() as stack:
        busy, longest, shorter = (stack.enter_context(Caller(served.port)) for _ in range(3))
        busy.ask("/held")
        assert served.entered.acquire(timeout=PATIENCE_S)
        for each in (longest, shorter):
            each.ask("/quick")
            assert each.status() == 200
        newcomer = stack.enter_context(Caller(served.port))
        newcomer.ask("/held")
        assert served.entered.acquire(timeout=PATIENCE_S)
        assert longest.is_ended()
        shorter.ask("/quick")
        assert shorter.status() == 200
        served.released.set()
        assert [busy.status(), newcomer.status()] == [200, 200]


def test_a_silent_connection_makes_room_once_it_had_time_to_ask(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(connection_limits, "TIME_TO_ASK_S", LONG_S)
    with serving(max_connections=1) as served, Caller(served.port) as silent:
        served.has_connections(1)
        with Caller(served.port) as further:
            further.problem(503)
        monkeypatch.setattr(connection_limits, "TIME_TO_ASK_S", 0.0)
        with Caller(served.port) as further:
            assert silent.is_ended()
            further.ask("/quick")
            assert further.status() == 200


def test_an_answer_that_is_still_on_its_way_makes_no_room():
    with serving(max_connections=1) as served, Caller(served.port) as reader:
        reader.ask("/quick")
        assert reader.status() == 200
        (connection,) = served.connections
        loop = connection.loop
        # More than both sockets hold.
        rest = bytes(20_000_000)
        loop.call_soon_threadsafe(connection.transport.write, rest)
        eventually(lambda: connection.transport.get_write_buffer_size() > 0, what="a full socket")
        with Caller(served.port) as further:
            further.problem(503)
        assert reader.read(len(rest)) == rest


FORM = "Host: 127.0.0.1\r\nContent-Type: multipart/form-data; boundary=x\r\n"
REFUSED_KIND = "Host: 127.0.0.1\r\nContent-Type: text/plain\r\n"
REFUSED_HOST = "Host: elsewhere.example\r\nContent-Type: text/plain\r\n"


def test_the_service_itself_holds_to_its_settings(embedded: Machine):
    settings = {"max_connections": 6, "head_time_limit_s": 2.0, "body_time_limit_s": 1.0}
    machine = Machine(embedded.data_dir, settings=settings)
    with running_service(machine, api_only=True) as service, contextlib.ExitStack() as stack:
        port = service.client.base_url.port
        assert port is not None
        path = service.submit()
        follower = stack.enter_context(Caller(port))
        events = follower.followed(f"{path}/events")

        slow = [stack.enter_context(Caller(port)) for _ in range(4)]
        slow[0].send("GET /v1/fits HTTP/1.1\r\nHo")
        for body, headers in zip(slow[1:], (FORM, REFUSED_KIND, REFUSED_HOST), strict=True):
            body.send(f"POST /v1/images HTTP/1.1\r\n{headers}Content-Length: 9\r\n\r\n")
        for body in slow[1:]:
            answer, content = body.answer()
            assert answer.status == 408
            assert answer.headers["x-request-id"]
            assert answer.headers["connection"] == "close"
            assert json.loads(content)["code"] == "body-too-slow"
            assert body.is_ended()
        assert slow[0].problem(408).code == "head-too-slow"

        with contextlib.ExitStack() as crowd:
            for _ in range(5):
                # The last one takes the place of the client, which asks nothing.
                crowd.enter_context(Caller(port)).followed(f"{path}/events")
            with Caller(port) as further:
                assert further.problem(503).code == "too-many-connections"
        eventually(lambda: service.client.post(f"{path}/cancel").is_success, what="canceled")
        assert b"event: end" in events.read()
