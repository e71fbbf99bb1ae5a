"""Uvicorn as we run it: told to stop, it first reports not ready, then stops."""

import threading
from types import FrameType
from typing import Final

import uvicorn
from starlette.types import ASGIApp

from service.api.connection_limits import ConnectionLimits, limited_protocol

GRACE_S: Final = 5
"""How long open requests may take to end; event streams end at once."""


class ApiServer(uvicorn.Server):
    """Serves an application until SIGTERM or SIGINT, and for ``stop_delay_s`` after it."""

    def __init__(
        self,
        app: ASGIApp,
        *,
        limits: ConnectionLimits,
        log_level: str,
        draining: threading.Event,
        stop_delay_s: float,
    ) -> None:
        super().__init__(
            uvicorn.Config(
                app,
                # Whatever else is installed: uvicorn's other implementations differ internally.
                http=limited_protocol(limits),
                ws="none",
                log_config=None,
                log_level=log_level.lower(),
                # Requests are logged where their ids are known.
                access_log=False,
                timeout_graceful_shutdown=GRACE_S,
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
