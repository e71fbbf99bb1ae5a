"""Observability of requests: an id, a log line and metrics for each."""

import logging
import re
import time
import uuid
from typing import Final

from starlette.datastructures import MutableHeaders
from starlette.requests import ClientDisconnect, Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from api_schemas.problems import problem
from service.api.metrics import ServiceMetrics
from service.api.problems import problem_response
from service.process.logs import fields, log_context

LOG: Final = logging.getLogger(__name__)

HEADER: Final = "x-request-id"
WELL_FORMED: Final = re.compile(r"[A-Za-z0-9._-]{1,64}")
QUIET: Final = ("/healthz/", "/metrics")
"""Requested by machines every few seconds: logged at DEBUG only."""


class Observation:
    """ASGI middleware, our outermost: sees every response, and turns an exception into one."""

    def __init__(self, app: ASGIApp, *, metrics: ServiceMetrics) -> None:
        self._app = app
        self._metrics = metrics

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, with its id."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        request = Request(scope)
        given = request.headers.get(HEADER, "")
        request_id = given if WELL_FORMED.fullmatch(given) else uuid.uuid4().hex
        request.state.request_id = request_id
        with log_context(request=request_id):
            started = time.monotonic()
            status = await self._answer(request, request_id, receive, send)
            seconds = time.monotonic() - started
            route = _route(scope)
            self._metrics.count(method=request.method, route=route, status=status, seconds=seconds)
            LOG.log(
                logging.DEBUG if request.url.path.startswith(QUIET) else logging.INFO,
                "%s %s",
                request.method,
                route,
                extra=fields(
                    status=status,
                    seconds=f"{seconds:.3f}",
                    **({"job": job} if (job := scope.get("path_params", {}).get("fit_id")) else {}),
                    **({"tenant": tenant} if (tenant := scope["state"].get("tenant")) else {}),
                ),
            )

    async def _answer(self, request: Request, request_id: str, receive: Receive, send: Send) -> int:
        # What the logs of proxies show for a client that hung up before there was an answer.
        status = 499

        async def identified(message: Message) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = message["status"]
                MutableHeaders(scope=message)[HEADER] = request_id
            await send(message)

        try:
            await self._app(request.scope, receive, identified)
        except ClientDisconnect:
            # The client hung up before its request was complete: there is nobody to answer.
            pass
        except Exception:
            LOG.exception("%s %s failed.", request.method, _route(request.scope))
            if status != 499:
                raise
            reason = problem(
                "internal-error",
                detail="An unexpected fault; it has been logged.",
                remedy="Try again later.",
            )
            await problem_response(request, reason)(request.scope, receive, identified)
        return status


def _route(scope: Scope) -> str:
    """The template of the path that answered: of limited number, and free of ids."""
    return getattr(scope.get("route"), "path", "other")
