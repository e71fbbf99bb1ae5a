"""An object storage that is away: callers are told at once, jobs wait for it."""

from pathlib import Path
from urllib.parse import urlsplit

import pytest
from moto.moto_server.werkzeug_app import MotoRequestHandler
from moto.server import ThreadedMotoServer

from tests.integration.service.harness import (
    Machine,
    Service,
    eventually,
    is_running,
    pids_noted,
    running_service,
)
from tests.object_storage import CREDENTIALS, ObjectStorage

JSON = "application/problem+json"


def started(port: int = 0) -> ThreadedMotoServer:
    """A server with what this process' servers have stored."""
    server = ThreadedMotoServer(ip_address="127.0.0.1", port=port, verbose=False)
    server.start()
    return server


def test_a_storage_that_is_away_is_told_and_waited_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    for name, value in CREDENTIALS.items():
        monkeypatch.setenv(name, value)
    # One request a connection: a server that has stopped answers on none.
    monkeypatch.setattr(MotoRequestHandler, "protocol_version", "HTTP/1.0")
    server = started()
    storage = ObjectStorage("http://{}:{}".format(*server.get_host_and_port()), "outages")
    note, gate = tmp_path / "pids", tmp_path / "gate"
    with running_service(Machine(tmp_path / "data", settings=storage.settings)) as service:
        ended = service.fitted()
        running = service.submit({"gate": str(gate), "note_pid": str(note)})
        (pid,) = eventually(lambda: pids_noted(note), what="the fit runs")

        server.stop()
        assert_refused_for_now(service, "POST", "/v1/fits")
        assert_refused_for_now(service, "GET", f"{ended}/result")
        assert_refused_for_now(service, "GET", "/healthz/ready")
        told = assert_refused_for_now(service, "DELETE", ended)
        assert "erased once that is back" in told
        assert service.client.get(ended).status_code == 404
        gate.touch()
        eventually(lambda: not is_running(pid), what="the fit is done")
        assert service.state(running) == "running"

        server = started(urlsplit(storage.endpoint_url).port or 0)
        job = service.ended(running)
        assert (job["state"], job["attempt"]) == ("succeeded", 1)
        assert service.client.get(f"{running}/result").status_code == 200
    server.stop()


def assert_refused_for_now(service: Service, method: str, path: str) -> str:
    """Ask, and return what is told."""
    answer = service.post() if method == "POST" else service.client.request(method, path)
    assert answer.status_code == 503, answer.text
    assert answer.headers["content-type"] == JSON
    assert int(answer.headers["Retry-After"]) > 0
    assert answer.json()["code"] == "storage-unavailable"
    return answer.json()["detail"]
