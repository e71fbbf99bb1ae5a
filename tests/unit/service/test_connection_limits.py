"""What we take from the inside of uvicorn is there, and is what we take it for."""

import asyncio
import inspect

import h11
import pytest
import uvicorn
from uvicorn.protocols.http.h11_impl import H11Protocol, RequestResponseCycle
from uvicorn.server import ServerState

from api_schemas.problems import Problem, problem
from service.api.connection_limits import ConnectionLimits, LimitedProtocol, limited_protocol
from service.api.farewell import raw_answer

LIMITS = ConnectionLimits(
    max_connections=2, head_time_limit_s=600.0, unread_body_time_limit_s=600.0
)


async def application(scope: object, receive: object, send: object) -> None:
    raise AssertionError


def protocol() -> LimitedProtocol:
    """A connection, made as uvicorn's server makes it."""
    config = uvicorn.Config(application, http=limited_protocol(LIMITS), ws="none")
    config.load()
    made = config.http_protocol_class(
        config=config,  # type: ignore[call-arg]
        server_state=ServerState(),
        app_state={},
        _loop=asyncio.get_running_loop(),
    )
    assert isinstance(made, LimitedProtocol)
    return made


@pytest.mark.parametrize(
    "name",
    [
        "connection_made",
        "connection_lost",
        "data_received",
        "on_response_complete",
        "send_400_response",
        "shutdown",
        "_unset_keepalive_if_required",
    ],
)
def test_uvicorn_still_has_the_methods_we_replace_or_call(name: str):
    # Where ours stands alone nothing would call it any more.
    assert inspect.isfunction(getattr(H11Protocol, name))
    if name in vars(LimitedProtocol):
        ours, theirs = (
            list(inspect.signature(getattr(each, name)).parameters)
            for each in (LimitedProtocol, H11Protocol)
        )
        assert ours == theirs


def test_uvicorn_still_calls_them_itself():
    source = inspect.getsource(H11Protocol)
    assert "on_response=self.on_response_complete" in source
    assert "self.send_400_response(" in source
    assert "connection.shutdown()" in inspect.getsource(uvicorn.Server.shutdown)


def test_uvicorn_still_has_the_state_we_look_at():
    async def check() -> None:
        made = protocol()
        assert isinstance(made.conn, h11.Connection)
        assert made.connections is made.server_state.connections
        assert isinstance(made.connections, set)
        assert isinstance(made.server_state.default_headers, list)
        assert made.cycle is None
        assert made.loop is asyncio.get_running_loop()

    asyncio.run(check())
    source = inspect.getsource(RequestResponseCycle.__init__)
    assert "self.response_started = False" in source
    assert "self.response_complete = False" in source


def test_servers_do_not_share_limits():
    few, many = limited_protocol(LIMITS), limited_protocol(LIMITS)
    assert few.gate is not many.gate


def test_a_raw_answer_is_one_that_a_client_can_read():
    reason = problem("too-many-connections", detail="Full.", remedy="Wait.")
    client = h11.Connection(h11.CLIENT)
    client.send(h11.Request(method="GET", target="/", headers=[("Host", "here")]))
    client.send(h11.EndOfMessage())
    client.receive_data(raw_answer(reason, [(b"date", b"today")]))
    head, body = client.next_event(), client.next_event()
    assert isinstance(head, h11.Response)
    assert isinstance(body, h11.Data)
    headers = dict(head.headers)
    assert head.status_code == 503
    assert headers[b"content-type"] == b"application/problem+json"
    assert headers[b"connection"] == b"close"
    assert headers[b"date"] == b"today"
    assert headers[b"x-content-type-options"] == b"nosniff"
    assert int(headers[b"retry-after"]) > 0
    assert Problem.model_validate_json(bytes(body.data)) == reason
