"""Files that come along with a request are checked beside the event loop."""

import asyncio
import threading

import httpx
import pytest
from starlette.requests import Request

from service.api import derivation_parts
from service.api.derivations import read_derivation
from service.jobs.inputs import TEXTURE
from service.submissions.submission import check_picture
from tests.integration.service.fake_pipeline import scripted_image


def request_of(sent: httpx.Request) -> Request:
    """What the API gets of a client's request."""

    async def receive() -> dict[str, object]:
        return {"type": "http.request", "body": sent.read(), "more_body": False}

    headers = [(name.lower(), value) for name, value in sent.headers.raw]
    scope = {"type": "http", "method": sent.method, "path": "/", "headers": headers}
    return Request(scope, receive)


def test_a_texture_is_checked_in_a_thread_of_its_own(monkeypatch: pytest.MonkeyPatch):
    painted = scripted_image(width=256, height=256)
    sent = httpx.Request(
        "POST",
        "http://localhost/",
        files={"texture": ("skin.png", painted, "image/png")},
        data={"request": '{"kind": "texture", "colours": "own"}'},
    )
    threads: list[threading.Thread] = []

    def noted(*arguments, **named):
        threads.append(threading.current_thread())
        return check_picture(*arguments, **named)

    monkeypatch.setattr(derivation_parts, "check_picture", noted)
    _, read = asyncio.run(read_derivation(request_of(sent), max_pixels=1_000_000))
    assert read.files[TEXTURE].content == painted
    assert len(threads) == 1
    assert threads[0] is not threading.current_thread()
