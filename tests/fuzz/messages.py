"""HTTP requests as the bytes that go over the wire."""

from collections.abc import Mapping
from dataclasses import dataclass

BOUNDARY = "limit"
MULTIPART = f"multipart/form-data; boundary={BOUNDARY}"
JSON = "application/json"


@dataclass(frozen=True, slots=True, kw_only=True)
class RawRequest:
    """What goes over the wire; ``is_well_framed`` unless its end cannot be told from its head."""

    content: bytes
    is_well_framed: bool = True


def head_and_body(path: str, media_type: str, body: bytes) -> RawRequest:
    """A POST."""
    head = (
        f"POST {path} HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: {media_type}\r\n"
        f"Content-Length: {len(body)}\r\nConnection: close\r\n\r\n"
    )
    return RawRequest(content=head.encode() + body)


def multipart(parts: Mapping[str, bytes]) -> bytes:
    """A form; all parts but ``request`` are files."""
    return b"".join([*(_part(*part) for part in parts.items()), f"--{BOUNDARY}--\r\n".encode()])


def _part(name: str, content: bytes) -> bytes:
    file = "" if name == "request" else '; filename="p"'
    head = f'--{BOUNDARY}\r\nContent-Disposition: form-data; name="{name}"{file}\r\n\r\n'
    return head.encode() + content + b"\r\n"
