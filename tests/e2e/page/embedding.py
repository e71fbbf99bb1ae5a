"""A site that shows the page in a frame: the documented example, served from another origin."""

import contextlib
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

from tests.e2e.service import REPOSITORY
from tests.readme import block

DOCUMENT = "\n".join(
    (REPOSITORY / "service" / "docs" / name).read_text()
    for name in ("embedding.md", "embedding_messages.md")
)
SERVICE = "https://measure.example"


@dataclass
class Site:
    """Its pages by path, and the tokens it hands out before it makes new ones."""

    origin: str
    pages: dict[str, str] = field(default_factory=dict)
    first_tokens: list[str] = field(default_factory=list)
    handed_out: list[str] = field(default_factory=list)
    make_token: Callable[[str], str] | None = None

    def token(self) -> str:
        assert self.make_token is not None
        found = self.first_tokens.pop(0) if self.first_tokens else self.make_token("customer-4711")
        self.handed_out.append(found)
        return found


@contextlib.contextmanager
def serving(host: str) -> Iterator[Site]:
    """Serve a site on a free port of the loopback, by this name of it."""

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            page = site.pages.get(self.path)
            self.answer(404 if page is None else 200, "text/html", page or "")

        def do_POST(self) -> None:
            self.answer(200, "text/plain", site.token())

        def answer(self, status: int, kind: str, text: str) -> None:
            content = text.encode()
            self.send_response(status)
            self.send_header("Content-Type", f"{kind}; charset=utf-8")
            self.send_header("Content-Length", str(len(content)))
            self.end_headers()
            self.wfile.write(content)

        def log_message(self, *_: Any) -> None:
            """Say nothing."""

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    site = Site(f"http://{host}:{server.server_port}")
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    try:
        yield site
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


def documented(name: str, service: str) -> str:
    """A page of the document, for the service at this address."""
    text = block(name, DOCUMENT)
    assert SERVICE in text
    return text.replace(SERVICE, service)


def documented_token_maker() -> Callable[[str], str]:
    """The Python function of the document."""
    found: dict[str, Any] = {}
    exec(compile(block("python", DOCUMENT), "embedding.md", "exec"), found)
    return found["new_token"]
