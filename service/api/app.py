"""The application: resources, problems, limits."""

import asyncio
import json
import threading
from collections.abc import AsyncIterator, Callable
from contextlib import AbstractAsyncContextManager, asynccontextmanager, suppress
from typing import Any, Final

from fastapi import Depends, FastAPI
from starlette.middleware.cors import CORSMiddleware

from service.api import (
    bodies,
    documentation,
    fits,
    health,
    images,
    initial_poses,
    openapi,
    page,
    picture_questions,
    problems,
    products,
    submissions,
)
from service.api.authentication import Authentication
from service.api.body_limits import BodyLimit, BodyTimeLimit, MessageFraming
from service.api.compression import Compression
from service.api.context import Parts
from service.api.credentials import KeyUses, KnownKeys
from service.api.estimates import Estimates
from service.api.event_feed import EventFeed
from service.api.local_guard import LocalGuard
from service.api.metrics import ServiceMetrics
from service.api.observation import Observation
from service.api.problems import install_problem_handlers
from service.api.rate_limit import RateLimit
from service.api.readiness import Readiness
from service.api.readiness import checks as readiness_checks
from service.api.request_form import check_form
from service.api.request_limit import RequestLimit
from service.api.security_headers import SecurityHeaders
from service.compute.lanes import Ask
from service.jobs.blobs import BlobStore
from service.jobs.engine import JobEngine
from service.jobs.keys import KeyRing
from service.process.data_folder import Disk
from service.settings import Settings
from service.submissions.image_header import ReadHeader
from service.version import VERSION

MULTIPART_OVERHEAD_BYTES: Final = 2_000_000
"""Allowance, besides the pictures, for the JSON part and the multipart's own lines."""


_ROUTERS: Final = (
    submissions.ROUTER,
    fits.ROUTER,
    products.ROUTER,
    images.ROUTER,
    picture_questions.ROUTER,
    initial_poses.ROUTER,
    bodies.ROUTER,
    health.ROUTER,
    problems.ROUTER,
    documentation.ROUTER,
    page.ROUTER,
)
"""In the order of the OpenAPI document."""

CORS_METHODS: Final = ("DELETE", "GET", "POST")
CORS_REQUEST_HEADERS: Final = (
    "Authorization",
    "Content-Type",
    "Idempotency-Key",
    "If-None-Match",
    "If-Range",
    "Last-Event-ID",
    "Prefer",
    "Range",
    "X-Request-Id",
)
CORS_ANSWER_HEADERS: Final = (
    "Content-Range",
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
    read_header: ReadHeader,
    keys: KeyRing,
    draining: threading.Event,
) -> FastAPI:
    """Build the application from what outlives it: engine, blobs, disk, keys and so on.

    ``ask`` has questions answered by estimators, ``read_header`` headers of pictures read.
    ``draining`` is set once the process is told to stop: it is then no longer ready, and event
    streams end.
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
    app.state.parts = Parts(
        settings=settings,
        engine=engine,
        blobs=blobs,
        disk=disk,
        estimates=Estimates(ask, metrics, estimators=settings.estimator_processes),
        feed=feed,
        metrics=metrics,
        draining=draining,
        readiness=Readiness(readiness_checks(engine, blobs, disk)),
        read_header=read_header,
    )
    _surround(
        app,
        settings=settings,
        keys=keys,
        metrics=metrics,
    )
    return app


def _surround(
    app: FastAPI,
    *,
    settings: Settings,
    keys: KeyRing,
    metrics: ServiceMetrics,
) -> None:
    """Put the layers around the resources, innermost first."""
    needs_keys = settings.authentication == "keys"
    app.add_middleware(BodyLimit, max_bytes=settings.max_upload_bytes + MULTIPART_OVERHEAD_BYTES)
    app.add_middleware(
        Authentication,
        keys=KnownKeys(keys) if needs_keys else None,
        uses=KeyUses(keys),
        rate_limit=RateLimit(per_minute=settings.requests_per_minute) if needs_keys else None,
    )
    if settings.allowed_origins:
        # Outside of authentication: browsers send CORS preflight requests without a key.
        app.add_middleware(
            CORSMiddleware,
            allow_origins=settings.allowed_origins,
            allow_methods=CORS_METHODS,
            allow_headers=CORS_REQUEST_HEADERS,
            expose_headers=CORS_ANSWER_HEADERS,
        )
    if not needs_keys:
        app.add_middleware(LocalGuard, allowed_origins=settings.allowed_origins)
    app.add_middleware(MessageFraming)
    # Outside of everything that reads or discards bodies.
    app.add_middleware(BodyTimeLimit, time_limit_s=settings.body_time_limit_s)
    app.add_middleware(Compression)
    app.add_middleware(RequestLimit)
    app.add_middleware(SecurityHeaders, cross_origin=bool(settings.allowed_origins))
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
    )
    install_problem_handlers(app)
    for router in _ROUTERS:
        app.include_router(router)
    documentation.mount_site(app)
    generate = app.openapi

    def complete() -> dict[str, Any]:
        if app.openapi_schema is None:
            app.openapi_schema = openapi.complete_openapi(generate())
        return app.openapi_schema

    app.openapi = complete
    return app
