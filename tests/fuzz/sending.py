"""HTTP requests as the bytes that go over the wire, put on a connection, and what comes back."""

import http.client
import json
import socket
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


PATIENCE_S = 300.0
IMPATIENCE_S = 0.3
"""What the server waits for the rest of, it need not answer."""

PROBLEM = "application/problem+json"
RETRY_LATER = 503
NOT_HTTP = b"Invalid HTTP request received."
"""What the server answers itself, in plain text, to what is no HTTP."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Answer:
    """Status, and what is wrong with the answer if anything is; status 0 if there was none."""

    status: int
    fault: str | None
    location: str | None = None


def send(port: int, request: RawRequest) -> Answer:
    """Send a request on a connection of its own."""
    patience_s = PATIENCE_S if request.is_well_framed else IMPATIENCE_S
    with socket.create_connection(("127.0.0.1", port), timeout=patience_s) as connection:
        try:
            connection.sendall(request.content)
            answer = http.client.HTTPResponse(connection)
            answer.begin()
            body = answer.read()
        except (OSError, http.client.HTTPException) as error:
            silent = f"no answer ({type(error).__name__})" if request.is_well_framed else None
            return Answer(status=0, fault=silent)
    return Answer(
        status=answer.status,
        fault=_fault(answer, body),
        location=answer.headers.get("Location"),
    )


def _fault(answer: http.client.HTTPResponse, body: bytes) -> str | None:
    if answer.status == RETRY_LATER:
        return None if answer.headers.get("Retry-After") else "503 without Retry-After"
    if answer.status >= 500:
        return f"{answer.status}: {body[:300]!r}"
    if (answer.status, body) == (400, NOT_HTTP):
        return None
    is_told = answer.headers.get_content_type() == PROBLEM
    # An answer to HEAD has no body to look at.
    if answer.status >= 400 and body and not is_told:
        return f"{answer.status} is no problem document: {body[:300]!r}"
    if answer.status >= 400 and is_told:
        return _incomplete(body)
    return None


def _incomplete(body: bytes) -> str | None:
    problem = json.loads(body)
    missing = [name for name in ("type", "detail", "remedy") if not problem.get(name)]
    return f"a problem without {', '.join(missing)}: {body[:300]!r}" if missing else None
