"""The settings that the documentation has for nginx, with Debian's nginx in front of a server."""

import contextlib
import socket
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.external_tools import found
from tests.integration.service.harness import eventually
from tests.integration.service.limited_server import Caller, Served, serving
from tests.readme import block

pytestmark = pytest.mark.usefixtures("no_fault_is_logged")
LIMIT_S = 2

AROUND = """
daemon off;
pid {folder}/pid;
error_log stderr;
events {{ worker_connections 1000; }}
http {{
    access_log off;
    client_body_temp_path {folder}/body;
    proxy_temp_path {folder}/proxy;
    fastcgi_temp_path {folder}/fastcgi;
    uwsgi_temp_path {folder}/uwsgi;
    scgi_temp_path {folder}/scgi;
{documented}
}}
"""


def documented(port: int, upstream: int) -> str:
    """The documented block, without TLS and with limits that a test can wait for."""
    text = block("nginx")
    for old, new in {
        "listen 443 ssl;": f"listen 127.0.0.1:{port};",
        "    ssl_certificate /etc/ssl/maquette.pem;\n": "",
        "    ssl_certificate_key /etc/ssl/maquette.key;\n": "",
        "server 127.0.0.1:8000;": f"server 127.0.0.1:{upstream};",
        "client_header_timeout 20s;": f"client_header_timeout {LIMIT_S}s;",
        "client_body_timeout 30s;": f"client_body_timeout {LIMIT_S}s;",
    }.items():
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return text


@contextlib.contextmanager
def proxied(served: Served, folder: Path) -> Iterator[int]:
    """Run nginx in front of a server; yields its port."""
    nginx = found("nginx", package="nginx-light")
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    configuration = folder / "nginx.conf"
    configuration.write_text(AROUND.format(folder=folder, documented=documented(port, served.port)))
    process = subprocess.Popen([nginx, "-c", configuration, "-e", "stderr"])
    try:
        eventually(lambda: _listens(port), what="nginx")
        yield port
    finally:
        process.terminate()
        process.wait()


def _listens(port: int) -> bool:
    with contextlib.suppress(ConnectionRefusedError), Caller(port):
        return True
    return False


def test_a_body_that_comes_byte_by_byte_is_ended_by_the_service(tmp_path: Path):
    with (
        serving(body_s=LIMIT_S) as served,
        proxied(served, tmp_path) as port,
        Caller(port) as slow,
    ):
        slow.ask("/length", method="POST", headers="Content-Length: 1000\r\n")
        slow.socket.settimeout(LIMIT_S / 10)
        early = b""
        while not early:
            slow.send("x")
            with contextlib.suppress(TimeoutError):
                early = slow.socket.recv(100_000)
        assert early.startswith(b"HTTP/1.1 408 ")
        assert b"body-too-slow" in early


def test_events_come_as_they_are_made(tmp_path: Path):
    with serving() as served, proxied(served, tmp_path) as port, Caller(port) as follower:
        stream = follower.followed("/stream")
        served.released.set()
        assert stream.read() == b"second\n"
