"""The application, its resources in its layers, and the server that runs it.

Uvicorn does not limit how long the head of a request takes: the proxy in front of it does
(``service/docs/operate/proxy.md``). How many connections there are is limited by
:mod:`service.process.listener`, what uvicorn hands the application by :mod:`service.api.limits`.
"""

import asyncio
import json
import socket
import threading
from collections.abc import AsyncIterator, Callable
from contextlib import AbstractAsyncContextManager, asynccontextmanager, suppress
from types import FrameType
from typing import Any, Final

import uvicorn
from fastapi import Depends, FastAPI
from starlette.middleware.cors import CORSMiddleware
from starlette.middleware.gzip import GZipMiddleware
from starlette.types import ASGIApp

from service.api import (
    fits,
    health,
    images,
    openapi,
    pages,
    problems,
    products,
    questions,
    submissions,
)
from service.api.auth import Authentication, LocalGuard
from service.api.context import Parts
from service.api.estimators import Estimators
from service.api.events import EventFeed
from service.api.headers import COMPRESSED_FROM_BYTES, LEFT_AS_THEY_ARE, SecurityHeaders
from service.api.health import Readiness
from service.api.limits import BodyLimits, RateLimit, RequestLimit
from service.api.observation import HeadAsGet, Observation, ServiceMetrics
from service.api.problems import install_problem_handlers
from service.api.requests import check_form
from service.compute.lanes import Ask
from service.jobs.blobs import BlobStore, WatchedBlobs
from service.jobs.engine import JobEngine
from service.jobs.keys import KeyRing
from service.process.data_folder import Disk
from service.settings import Settings
from service.submissions.image_header import ReadHeader
from service.version import VERSION

MULTIPART_OVERHEAD_BYTES: Final = 2_000_000
"""Allowance, besides the pictures, for the JSON part and the multipart's own lines."""

GRACE_S: Final = 5
"""The time in which open requests may end; event streams end at once."""

IDLE_S: Final = 5
"""The longest pause between two requests of a connection."""

HEAD_BYTES: Final = 65_536
"""The longest head of a request."""

UNREAD_S: Final = 30
"""The longest time in which a reader may take nothing of an answer."""

_ROUTERS: Final = (
    submissions.ROUTER,
    fits.ROUTER,
    products.ROUTER,
    images.ROUTER,
    questions.ROUTER,
    health.ROUTER,
    problems.ROUTER,
    pages.ROUTER,
)
"""All resources, in the order of the OpenAPI document."""

CORS_METHODS: Final = ("DELETE", "GET", "POST")
CORS_REQUEST_HEADERS: Final = (
    "Authorization",
    "Content-Type",
    "Idempotency-Key",
    "If-None-Match",
    "Last-Event-ID",
    "Prefer",
    "X-Request-Id",
)
CORS_ANSWER_HEADERS: Final = (
    "ETag",
    "Link",
    "Location",
    "Preference-Applied",
    "Retry-After",
    "X-Request-Id",
)


def create_app(
    *,
    settings: Settings,
    engine: JobEngine,
    blobs: BlobStore,
    disk: Disk,
    ask: Ask,
    read_header_for: Callable[[str], ReadHeader],
    keys: KeyRing,
    draining: threading.Event,
) -> FastAPI:
    """Build the application from what outlives it: engine, blobs, disk, keys and so on.

    ``ask`` has questions answered by estimators, ``read_header_for`` headers of an owner's pictures
    read. ``draining`` is set once the process is told to stop: it is then no longer ready, and
    event streams end.
    """
    feed = EventFeed(engine, draining)

    @asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncIterator[None]:
        following = asyncio.create_task(feed.run())
        yield
        following.cancel()
        with suppress(asyncio.CancelledError):
            await following

    app = _resources(lifespan)
    metrics = ServiceMetrics(engine, disk)
    watched = WatchedBlobs(blobs)
    app.state.parts = Parts(
        settings=settings,
        engine=engine,
        blobs=watched,
        disk=disk,
        estimators=Estimators(ask, estimators=settings.estimator_processes),
        feed=feed,
        metrics=metrics,
        draining=draining,
        read_header_for=read_header_for,
    )
    app.state.readiness = Readiness(health.checks(engine, watched, disk))
    _surround(app, settings=settings, keys=keys, metrics=metrics)
    return app


def _surround(app: FastAPI, *, settings: Settings, keys: KeyRing, metrics: ServiceMetrics) -> None:
    """Put the layers around the resources, innermost first."""
    if settings.authentication == "keys":
        rate_limit = RateLimit(per_minute=settings.requests_per_minute)
        app.add_middleware(Authentication, keys=keys, rate_limit=rate_limit)
    else:
        app.add_middleware(LocalGuard, allowed_origins=settings.cors_origins)
    app.add_middleware(
        BodyLimits,
        max_bytes=settings.max_upload_bytes + MULTIPART_OVERHEAD_BYTES,
        time_limit_s=settings.body_time_limit_s,
    )
    if settings.cors_origins:
        # Outside of what refuses: browsers read only answers with its headers, and send their
        # preflight requests without a key.
        app.add_middleware(
            CORSMiddleware,
            allow_origins=settings.cors_origins,
            allow_methods=CORS_METHODS,
            allow_headers=CORS_REQUEST_HEADERS,
            expose_headers=CORS_ANSWER_HEADERS,
        )
    app.add_middleware(
        GZipMiddleware,
        minimum_size=COMPRESSED_FROM_BYTES,
        compresslevel=6,
        exclude_content_types=LEFT_AS_THEY_ARE,
    )
    app.add_middleware(RequestLimit)
    app.add_middleware(SecurityHeaders, cross_origin=bool(settings.cors_origins))
    app.add_middleware(HeadAsGet)
    app.add_middleware(Observation, metrics=metrics)


def openapi_text() -> str:
    """Return the OpenAPI document as exported next to the wire types."""
    return json.dumps(_resources(None).openapi(), indent=1, ensure_ascii=False) + "\n"


def _resources(lifespan: Callable[[FastAPI], AbstractAsyncContextManager[None]] | None) -> FastAPI:
    app = FastAPI(
        title="Maquette",
        version=VERSION,
        summary=openapi.SUMMARY,
        description=openapi.DESCRIPTION,
        license_info=dict(openapi.LICENCE),
        openapi_tags=[dict(tag) for tag in openapi.TAGS],
        servers=[dict(server) for server in openapi.SERVERS],
        lifespan=lifespan,
        docs_url=None,
        redoc_url=None,
        # Paths are exact: a redirect would be a response that no schema describes.
        redirect_slashes=False,
        generate_unique_id_function=lambda route: route.name,
        dependencies=[Depends(check_form)],
        responses=openapi.ANSWERED_EVERYWHERE,
    )
    install_problem_handlers(app)
    for router in _ROUTERS:
        app.include_router(router)
    pages.mount_files(app)
    generate = app.openapi

    def complete() -> dict[str, Any]:
        if app.openapi_schema is None:
            app.openapi_schema = openapi.complete_openapi(generate())
        return app.openapi_schema

    app.openapi = complete
    return app


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
                # Whatever else is installed: only h11 keeps to the longest head, and only asyncio
                # has the listener accept connections.
                http="h11",
                loop="asyncio",
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

    def run(self, sockets: list[socket.socket] | None = None) -> None:
        """Serve; whoever takes nothing of an answer for long is not waited for."""
        for each in sockets or ():
            # Only Linux has it. Connections inherit it from the socket they are accepted at.
            if hasattr(socket, "TCP_USER_TIMEOUT"):
                each.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, UNREAD_S * 1000)
        super().run(sockets)

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
