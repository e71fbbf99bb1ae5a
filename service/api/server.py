"""Uvicorn as we run it: told to stop, it first reports not ready, then stops.

Uvicorn limits neither how long the head of a request takes nor how many connections there are: the
proxy in front of it does (``service/docs/operate/proxy.md``). The application limits what uvicorn
hands it: how long a body takes (:mod:`service.api.body_limits`), and how many requests there are at
the same time (:mod:`service.api.request_limit`).
"""

import threading
from types import FrameType
from typing import Final

import uvicorn
from starlette.types import ASGIApp

GRACE_S: Final = 5
"""How long open requests may take to end; event streams end at once."""

IDLE_S: Final = 5
"""How long a connection may stay open between two requests."""

HEAD_BYTES: Final = 65_536
"""The longest head of a request."""


class ApiServer(uvicorn.Server):
    """Serves an application until SIGTERM or SIGINT, and for ``stop_delay_s`` after it."""

    def __init__(
        self,
        app: ASGIApp,
        *,
        log_level: str,
        draining: threading.Event,
        stop_delay_s: float,
    ) -> None:
        super().__init__(
            uvicorn.Config(
                app,
                # Whatever else is installed: only h11 keeps to the longest head.
                http="h11",
                h11_max_incomplete_event_size=HEAD_BYTES,
                timeout_keep_alive=IDLE_S,
                timeout_graceful_shutdown=GRACE_S,
                ws="none",
                log_config=None,
                log_level=log_level.lower(),
                # Requests are logged where their ids are known.
                access_log=False,
                server_header=False,
            )
        )
        self._draining = draining
        self._stop_delay_s = stop_delay_s

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        """Report not ready; stop after the delay, or at once at the second signal."""
        if self._draining.is_set() or self._stop_delay_s == 0.0:
            self._draining.set()
            super().handle_exit(sig, frame)
            return
        self._draining.set()
        timer = threading.Timer(self._stop_delay_s, super().handle_exit, (sig, frame))
        timer.daemon = True
        timer.start()
