"""The application: resources, problems, limits."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from typing import Any, Final

from fastapi import FastAPI

from service.api import body_models, events, fits, health, problem_types, results
from service.api.body_limit import BodyLimit
from service.api.context import ApiContext
from service.api.event_feed import EventFeed
from service.api.openapi import complete_openapi
from service.api.problems import install_problem_handlers
from service.blobs import BlobStore
from service.engine.port import JobEngine
from service.settings import Settings

API_VERSION: Final = "1.0.0"

MULTIPART_OVERHEAD_BYTES: Final = 2_000_000
"""Room beside the pictures for the JSON part and the multipart's own lines."""


def create_app(*, settings: Settings, engine: JobEngine, blobs: BlobStore) -> FastAPI:
    """Build the application on an engine and a blob store that live as long as it does."""
    feed = EventFeed(engine)

    @asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncIterator[None]:
        following = asyncio.create_task(feed.run())
        yield
        following.cancel()
        with suppress(asyncio.CancelledError):
            await following

    app = FastAPI(
        title="Maquette",
        version=API_VERSION,
        summary="Human body shape, pose, light and measurements from a single picture.",
        lifespan=lifespan,
        redoc_url=None,
        # Paths are exact: a redirect would be an answer that no schema describes.
        redirect_slashes=False,
    )
    app.state.context = ApiContext(settings=settings, engine=engine, blobs=blobs, feed=feed)
    app.add_middleware(BodyLimit, max_bytes=settings.max_upload_bytes + MULTIPART_OVERHEAD_BYTES)
    install_problem_handlers(app)
    for resource in (fits, events, results, body_models, health, problem_types):
        app.include_router(resource.ROUTER)
    _install_openapi(app)
    return app


def _install_openapi(app: FastAPI) -> None:
    generate = app.openapi

    def openapi() -> dict[str, Any]:
        if app.openapi_schema is None:
            app.openapi_schema = complete_openapi(generate())
        return app.openapi_schema

    app.openapi = openapi
