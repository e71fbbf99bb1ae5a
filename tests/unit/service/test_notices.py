"""Notices: how they are signed, where they may go, and that the address is pinned."""

import asyncio
import base64
import datetime
import http.server
import ipaddress
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
from service.jobs.notices import (
    NotAcceptedError,
    is_public,
    is_refused_outright,
    post,
    resolve,
    signed_headers,
)

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


@pytest.mark.parametrize("length", [24, 32, 64])
def test_every_length_the_standard_allows_is_accepted(length):
    secret = "whsec_" + base64.b64encode(bytes(length)).decode()
    assert WebhookTarget(url="https://example.org/", secret=secret).secret == secret


PRIVATE = [
    "0.0.0.0",
    "10.1.2.3",
    "100.64.0.1",
    "127.0.0.1",
    "127.8.8.8",
    "169.254.169.254",
    "172.16.0.1",
    "192.0.0.1",
    "192.0.0.8",
    "192.0.0.9",
    "192.0.0.170",
    "192.0.0.192",
    "192.0.2.1",
    "192.31.196.1",
    "192.52.193.1",
    "192.88.99.1",
    "192.88.99.2",
    "192.175.48.1",
    "168.63.129.16",
    "192.168.0.1",
    "198.18.0.1",
    "198.51.100.1",
    "203.0.113.1",
    "224.0.0.1",
    "240.0.0.1",
    "255.255.255.255",
    "::",
    "::1",
    "::127.0.0.1",
    "::ffff:127.0.0.1",
    "::ffff:169.254.169.254",
    "64:ff9b::10.0.0.1",
    "64:ff9b::192.88.99.1",
    "64:ff9b:1::1",
    # Translations of other addresses, public ones too.
    "64:ff9b::1.1.1.1",
    "2002:101:101::",
    "100::1",
    "100:0:0:1::1",
    "2002:7f00:1::",
    "2002:c058:6301::",
    "2001:0:7f00:1::",
    "2001:1::1",
    "2001:2::1",
    "2001:4:112::1",
    "2001:20::1",
    "2620:4f:8000::1",
    "3ffe::1",
    "3fff::1",
    "3fff:fff:ffff::1",
    "5f00::1",
    "fc00::1",
    "fd00:ec2::254",
    "fe80::1",
    "fec0::1",
    "ff02::1",
    "2001:db8::1",
]
PUBLIC = [
    "1.1.1.1",
    "93.184.216.34",
    # Neighbours of special networks.
    "192.0.1.1",
    "192.88.98.1",
    "192.88.100.1",
    "168.63.129.15",
    "2001:200::1",
    "2606:4700:4700::1111",
    "3fff:1000::1",
]


@pytest.mark.parametrize("address", PRIVATE)
def test_no_notice_goes_to_an_address_that_is_not_public(address):
    assert not is_public(ipaddress.ip_address(address))
    assert is_refused_outright(address, ())
    with pytest.raises(NotAcceptedError, match="not public"):
        asyncio.run(resolve(address, ()))


@pytest.mark.parametrize("address", PUBLIC)
def test_public_addresses_are_public(address):
    assert is_public(ipaddress.ip_address(address))
    assert not is_refused_outright(address, ())
    assert asyncio.run(resolve(address, ())) == [ipaddress.ip_address(address)]


@pytest.mark.parametrize("host", ["127.1", "0x7f000001", "2130706433", "localhost", "0177.0.0.1"])
def test_other_ways_to_write_this_machine_are_found_out_when_they_are_looked_up(host):
    with pytest.raises(NotAcceptedError):
        asyncio.run(resolve(host, ()))


def test_a_name_of_public_and_private_addresses_leads_to_the_public_ones(monkeypatch):
    async def lookup(host, port, **_):
        return [(2, 1, 6, "", (each, port)) for each in ("10.0.0.1", "1.1.1.1", "127.0.0.1")]

    async def resolved():
        monkeypatch.setattr(asyncio.get_running_loop(), "getaddrinfo", lookup)
        return await resolve("mixed.example", ())

    assert asyncio.run(resolved()) == [ipaddress.ip_address("1.1.1.1")]


def test_hosts_the_settings_name_may_be_anywhere():
    assert asyncio.run(resolve("127.0.0.1", ("127.0.0.1",)))
    assert not is_refused_outright("localhost", ("localhost",))


def test_an_unknown_name_says_so():
    with pytest.raises(NotAcceptedError, match="resolved"):
        asyncio.run(resolve("no-such-host.invalid", ()))
