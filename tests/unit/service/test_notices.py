"""Notices: how they are signed, and sent over TLS, where the address is pinned."""

import asyncio
import base64
import datetime
import hashlib
import hmac
import http.server
import socket
import ssl
import threading
from collections.abc import Iterator
from dataclasses import dataclass

import pytest
from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import NameOID
from pydantic import ValidationError

from api_schemas.jobs import WebhookTarget
from service.jobs import notices
from service.jobs.notices import NotAcceptedError, post, signed_headers

NAME = "hooks.example"
PATIENCE_S = 600.0


@dataclass
class Server:
    port: int
    certificate: bytes
    hosts: list[str]
    lookups: int = 0


@pytest.fixture
def server(tmp_path) -> Iterator[Server]:
    certificate, key = self_signed(NAME)
    (tmp_path / "both.pem").write_bytes(certificate + key)
    hosts: list[str] = []

    class Handler(http.server.BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            hosts.append(self.headers["host"])
            self.send_response(200)
            self.end_headers()

        def log_message(self, *_: object) -> None:
            return

    listening = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(tmp_path / "both.pem")
    listening.socket = context.wrap_socket(listening.socket, server_side=True)
    listening.handle_error = lambda *_: None  # a client that turns away is expected here
    thread = threading.Thread(target=listening.serve_forever)
    thread.start()
    yield Server(port=listening.server_address[1], certificate=certificate, hosts=hosts)
    listening.shutdown()
    thread.join()
    listening.server_close()


def self_signed(name: str) -> tuple[bytes, bytes]:
    key = ec.generate_private_key(ec.SECP256R1())
    subject = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, name)])
    now = datetime.datetime.now(datetime.UTC)
    certificate = (
        x509.CertificateBuilder()
        .subject_name(subject)
        .issuer_name(subject)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - datetime.timedelta(days=1))
        .not_valid_after(now + datetime.timedelta(days=1))
        .add_extension(x509.SubjectAlternativeName([x509.DNSName(name)]), critical=False)
        .add_extension(x509.BasicConstraints(ca=True, path_length=None), critical=True)
        .sign(key, hashes.SHA256())
    )
    return (
        certificate.public_bytes(serialization.Encoding.PEM),
        key.private_bytes(
            serialization.Encoding.PEM,
            serialization.PrivateFormat.PKCS8,
            serialization.NoEncryption(),
        ),
    )


def posted(server: Server, name: str, monkeypatch) -> int:
    """Post to a name that stands for the loopback the first time it is looked up, and only then."""
    trusting = ssl.create_default_context(cadata=server.certificate.decode())
    monkeypatch.setattr(notices, "CONNECT_WITHIN_S", PATIENCE_S)
    monkeypatch.setattr(notices, "ATTEMPT_WITHIN_S", PATIENCE_S)

    async def lookup(host: str, port: int, **_: object) -> list[object]:
        server.lookups += 1
        address = "127.0.0.1" if (host, server.lookups) == (name, 1) else "192.0.2.1"
        return [(2, 1, 6, "", (address, port))]

    async def looking() -> int:
        monkeypatch.setattr(asyncio.get_running_loop(), "getaddrinfo", lookup)
        url = f"https://{name}:{server.port}/hook"
        return await post(url, {}, b"{}", allowed_hosts=[name], tls=trusting)

    return asyncio.run(looking())


def test_the_name_is_looked_up_once_and_its_certificate_checked(server, monkeypatch):
    assert posted(server, NAME, monkeypatch) == 200
    assert server.hosts == [f"{NAME}:{server.port}"]


def test_a_certificate_for_another_name_is_refused(server, monkeypatch):
    with pytest.raises(NotAcceptedError, match=r"none that lasted \(ConnectError\)"):
        posted(server, "other.example", monkeypatch)
    assert server.hosts == []


async def unknown(host: str, port: int, **_: object) -> list[object]:
    raise socket.gaierror(socket.EAI_NONAME, "Name or service not known")


async def private(host: str, port: int, **_: object) -> list[object]:
    return [(2, 1, 6, "", (each, port)) for each in ("10.0.0.7", "192.168.1.1")]


async def silent(host: str, port: int, **_: object) -> list[object]:
    await asyncio.sleep(3_600)
    return []


@pytest.mark.parametrize("lookup", [unknown, private, silent])
def test_a_name_that_leads_nowhere_is_not_posted_to(lookup, monkeypatch):
    monkeypatch.setattr(notices, "ATTEMPT_WITHIN_S", 0.3)

    async def looking() -> int:
        monkeypatch.setattr(asyncio.get_running_loop(), "getaddrinfo", lookup)
        return await post("https://db.internal/hook", {}, b"{}", allowed_hosts=())

    with pytest.raises(NotAcceptedError) as raised:
        asyncio.run(looking())
    assert "db.internal" not in str(raised.value)


SECRET = "whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw"


def test_the_signature_is_the_one_of_the_standards_example():
    """Message, secret and signature are those of the specification's reference libraries."""
    headers = signed_headers(
        notice_id="msg_p5jXN8AQM9LWM0D4loKWxJek",
        timestamp=1614265330,
        body=b'{"test": 2432232314}',
        secret=SECRET,
    )
    assert headers == {
        "webhook-id": "msg_p5jXN8AQM9LWM0D4loKWxJek",
        "webhook-timestamp": "1614265330",
        "webhook-signature": "v1,g0hM9SsE+OTPJTGt/tmIKtSyZlE3uFJELVlNIOLJ1OE=",
    }


@pytest.mark.parametrize("change", ["id", "timestamp", "body", "secret"])
def test_the_signature_covers_everything(change):
    values = {"notice_id": "a", "timestamp": 1, "body": b"{}", "secret": SECRET}
    changed = {
        "id": {"notice_id": "b"},
        "timestamp": {"timestamp": 2},
        "body": {"body": b"[]"},
        "secret": {"secret": "whsec_" + base64.b64encode(bytes(24)).decode()},
    }[change]
    one, other = signed_headers(**values), signed_headers(**(values | changed))
    assert one["webhook-signature"] != other["webhook-signature"]


def test_the_key_is_what_the_secret_encodes():
    key = bytes(range(32))
    secret = "whsec_" + base64.b64encode(key).decode()
    headers = signed_headers(notice_id="n", timestamp=7, body=b"x", secret=secret)
    expected = base64.b64encode(hmac.new(key, b"n.7.x", hashlib.sha256).digest()).decode()
    assert headers["webhook-signature"] == f"v1,{expected}"


@pytest.mark.parametrize(
    "secret",
    [
        base64.b64encode(bytes(32)).decode(),
        "whsec_" + base64.b64encode(bytes(23)).decode(),
        "whsec_" + base64.b64encode(bytes(65)).decode(),
        "whsec_not base64!",
    ],
)
def test_a_weak_or_malformed_secret_is_refused(secret):
    with pytest.raises(ValidationError):
        WebhookTarget(url="https://example.org/", secret=secret)


@pytest.mark.parametrize("length", range(24, 65))
def test_every_length_the_standard_allows_is_accepted(length):
    secret = "whsec_" + base64.b64encode(bytes(length)).decode()
    assert WebhookTarget(url="https://example.org/", secret=secret).secret == secret
