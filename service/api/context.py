"""What the resources share, built once in :func:`service.api.app.create_app`."""

from dataclasses import dataclass
from typing import Annotated

from fastapi import Depends, Request

from service.api.event_feed import EventFeed
from service.blobs import BlobStore
from service.engine.port import JobEngine
from service.settings import Settings


@dataclass(frozen=True, slots=True, kw_only=True)
class ApiContext:
    """Settings, jobs, blobs and the feed of their events."""

    settings: Settings
    engine: JobEngine
    blobs: BlobStore
    feed: EventFeed


def _context(request: Request) -> ApiContext:
    return request.app.state.context


Context = Annotated[ApiContext, Depends(_context)]
