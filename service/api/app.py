"""The application: resources, problems, limits."""

import asyncio
import json
from collections.abc import AsyncIterator, Callable
from contextlib import AbstractAsyncContextManager, asynccontextmanager, suppress
from typing import Any, Final

from fastapi import FastAPI

from service.api import body_models, events, fits, health, problem_types, results, submissions
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

    app = _resources(lifespan)
    app.state.context = ApiContext(settings=settings, engine=engine, blobs=blobs, feed=feed)
    app.add_middleware(BodyLimit, max_bytes=settings.max_upload_bytes + MULTIPART_OVERHEAD_BYTES)
    return app


def openapi_text() -> str:
    """Return the OpenAPI document as it is exported beside the wire types."""
    return json.dumps(_resources(None).openapi(), indent=1, ensure_ascii=False) + "\n"


def _resources(lifespan: Callable[[FastAPI], AbstractAsyncContextManager[None]] | None) -> FastAPI:
    app = FastAPI(
        title="Maquette",
        version=API_VERSION,
        summary="Human body shape, pose, light and measurements from a single picture.",
        lifespan=lifespan,
        redoc_url=None,
        # Paths are exact: a redirect would be an answer that no schema describes.
        redirect_slashes=False,
        generate_unique_id_function=lambda route: route.name,
    )
    install_problem_handlers(app)
    for resource in (submissions, fits, events, results, body_models, health, problem_types):
        app.include_router(resource.ROUTER)
    generate = app.openapi

    def openapi() -> dict[str, Any]:
        if app.openapi_schema is None:
            app.openapi_schema = complete_openapi(generate())
        return app.openapi_schema

    app.openapi = openapi
    return app
